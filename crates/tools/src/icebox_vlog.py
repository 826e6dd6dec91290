# icebox_vlog, with the name that its table of the UP5K's PLL lacks: without it, it stops at an SB_PLL40_CORE. What the bit does is of
# no interest to who reads this back, for the PLL is a model of the bench.
import os
import runpy
import shutil
import sys

program = os.path.realpath(shutil.which("icebox_vlog"))
sys.path.insert(0, os.path.dirname(program))
import icebox

for pll in icebox.pllinfo_db.values():
    if "SHIFTREG_DIV_MODE_0" in pll:
        pll["SHIFTREG_DIV_MODE"] = pll["SHIFTREG_DIV_MODE_0"]
sys.argv[0] = program
runpy.run_path(program, run_name="__main__")
