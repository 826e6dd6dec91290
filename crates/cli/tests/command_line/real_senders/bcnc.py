"""Drives a serial port by bCNC's own sender, without a window, for tests.

    python bcnc.py FOLDER_OF_BCNC PORT PROGRAM

The program is paused and resumed, with the feed at 110 %, and the last line of the output says what
the sender then knows: `settings`, `lines`, `place`, `state`.
"""

import builtins
import json
import os
import sys
import time

folder, port, program = sys.argv[1:]
sys.path[:0] = [os.path.join(folder, name) for name in ("", "lib", "plugins", "controllers")]
# Texts are not translated.
builtins._ = lambda text: text

import Utils  # noqa: E402
from CNC import CNC, WAIT  # noqa: E402
from Sender import Sender  # noqa: E402

PATIENCE = 900


class Headless(Sender):
    """What the window adds to the sender, as far as a run needs it."""

    def disable(self):
        """No buttons are there to be disabled."""

    def until(self, what, is_it):
        """Waits, and looks meanwhile for the end of a run, as the window does."""
        begin = time.time()
        while not is_it():
            if time.time() - begin > PATIENCE:
                sys.exit(f"no {what}: {CNC.vars['state']} {self._gcount} of {self._runLines}")
            while not self.log.empty():
                kind, line = self.log.get_nowait()
                if "error:" in line or "ALARM" in line:
                    sys.exit(f"{kind}: {line}")
            if self.running and self._gcount >= self._runLines:
                self.runEnded()
            time.sleep(0.01)

    def begin(self):
        """What `run` of the window does with the file that is loaded."""
        self.initRun()
        self._runLines = sys.maxsize
        self._gcount = 0
        CNC.vars["running"] = True
        paths = self.gcode.compile(self.queue)
        self._runLines = len(paths) + 1
        self.queue.put((WAIT,))
        return len(paths)


def main():
    """One program."""
    Utils.loadConfiguration()
    sender = Headless()
    sender.open(port, 115200)
    sender.until("welcome", lambda: CNC.vars["state"] == "Idle")
    sender.sendGCode("$$")
    sender.until("settings", lambda: "grbl_132" in CNC.vars)
    sender.gcode.load(program)
    lines = sender.begin()
    sender.until("motion", lambda: sender._gcount > lines // 4 and CNC.vars["state"] == "Run")
    CNC.vars["_OvFeed"] = 110
    CNC.vars["_OvChanged"] = True
    sender.until("override", lambda: CNC.vars["OvFeed"] == 110)
    sender.pause()
    sender.until("hold", lambda: CNC.vars["state"].startswith("Hold"))
    sender.pause()
    sender.until("end", lambda: not sender.running)
    sender.until("rest", lambda: CNC.vars["state"] == "Idle")
    said = {
        "settings": [CNC.vars[f"grbl_{number}"] for number in (100, 101, 102)],
        "lines": lines,
        "place": [CNC.vars[axis] for axis in ("mx", "my", "mz")],
        "state": CNC.vars["state"],
    }
    sender.close()
    print(json.dumps(said))


main()
