"""Prints the canonical moves of G-code programs as LinuxCNC's interpreter gives them.

usage: /usr/bin/python3 canon.py PROGRAM...    (LinuxCNC 2.9)

For each program: `@program PATH`, a line for each move, and `@end` or `@refused REASON`. Lines
without `@` are from LinuxCNC itself. Places are in machine coordinates, X, Y and Z in mm. Each
program is read in a process of its own, with a time limit, because some of them end the process.
"""

import ctypes
import os
import signal
import sys
import tempfile

SECONDS = 10
TOOLS = 99


def make_tool_table(folder):
    """Makes the tool table that the interpreter expects in the user's folder: tools of no length."""
    os.environ["HOME"] = folder
    tools = ctypes.CDLL("libtooldata.so.0", mode=ctypes.RTLD_GLOBAL)
    status = ctypes.create_string_buffer(1 << 16)
    tools._Z17tool_mmap_creatorPK13EMC_TOOL_STATi(status, 0)
    tools._Z13tooldata_initb(False)
    table = os.path.join(folder, "tools.tbl")
    with open(table, "w") as file:
        for tool in range(1, TOOLS):
            file.write("T%d P%d Z0 D0\n" % (tool, tool))
    tools._Z13tooldata_loadPKcPPc(table.encode(), None)


def canon_class():
    """The canon; its base class needs the module `gcode`, which needs the tool table."""
    from rs274.interpret import Translated

    class Canon(Translated):
        def __init__(self, parameter_file):
            self.parameter_file = parameter_file
            self.tool = (0.0,) * 9
            self.plane = 1
            self.line = 0
            self.set_xy_rotation(0)

        def __getattr__(self, name):
            if name.startswith("_") or name == "state":
                raise AttributeError(name)
            return lambda *_: None

        def next_line(self, state):
            self.state = state
            self.line = state.sequence_number

        def say(self, word, *numbers):
            print("@" + word, self.line, *(repr(float(number)) for number in numbers))

        def place(self, place):
            # The module gives lengths in inches.
            moved = self.rotate_and_translate(*place)
            moved = [moved[axis] + self.tool[axis] for axis in range(6)]
            return [25.4 * moved[axis] for axis in range(3)] + moved[3:]

        def tool_offset(self, *offset):
            self.tool = offset

        def set_plane(self, plane):
            self.plane = plane

        def set_feed_rate(self, rate):
            self.say("rate", 25.4 * rate)

        def straight_traverse(self, *to):
            self.say("traverse", *self.place(to))

        def straight_feed(self, *to):
            self.say("feed", *self.place(to))

        def straight_probe(self, *to):
            self.say("probe", *self.place(to))

        def arc_feed(self, first, second, first_centre, second_centre, turns, normal, *rest):
            axes = {1: (0, 1, 2), 2: (1, 2, 0), 3: (2, 0, 1)}[self.plane]
            end = [0.0] * 3 + list(rest)
            end[axes[0]], end[axes[1]], end[axes[2]] = first, second, normal
            centre = list(end)
            centre[axes[0]], centre[axes[1]] = first_centre, second_centre
            centre = self.place(centre)
            in_plane = [centre[axes[0]], centre[axes[1]]]
            self.say("arc", *self.place(end), *in_plane, turns, self.plane)

        def dwell(self, seconds):
            self.say("dwell", seconds)

        def get_external_angular_units(self):
            return 1.0

        def get_external_length_units(self):
            return 1.0

        def get_axis_mask(self):
            return 63

        def get_block_delete(self):
            return 1

        def get_tool(self, _):
            return (-1,) + (0.0,) * 12 + (0,)

    return Canon


def run(path, folder):
    """Reads one program and prints its moves."""
    make_tool_table(folder)
    import gcode

    parameters = os.path.join(folder, "parameters")
    open(parameters, "w").close()
    os.chdir(os.path.dirname(os.path.abspath(path)))
    result, line = gcode.parse(path, canon_class()(parameters), "G21", "")
    if result > gcode.MIN_ERROR:
        print("@refused line", line, gcode.strerror(result).replace("\n", " "))
    else:
        print("@end")


for program in map(os.path.abspath, sys.argv[1:]):
    print("@program", program, flush=True)
    with tempfile.TemporaryDirectory() as folder:
        child = os.fork()
        if child == 0:
            signal.alarm(SECONDS)
            try:
                run(program, folder)
            except BaseException as error:
                print("@refused", type(error).__name__, str(error).replace("\n", " "))
            sys.stdout.flush()
            os._exit(0)
        status = os.waitpid(child, 0)[1]
    if status != 0:
        print("\n@refused the process ended with status", status, flush=True)
