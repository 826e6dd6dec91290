# Runs icebox_vlog with an entry that its table for the PLL of the UP5K lacks; without the entry it
# stops at an SB_PLL40_CORE. The function of that bit does not matter here, because the bench
# replaces the PLL by a model.
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
