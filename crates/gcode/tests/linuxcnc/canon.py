"""Prints the canonical moves of G-code programs as LinuxCNC's interpreter gives them.

usage: /usr/bin/python3 canon.py TOOLS PROGRAM...    (LinuxCNC 2.9)

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


def load_tool_table(folder, table):
    """Loads the tool table into shared memory, where the interpreter looks for it."""
    os.environ["HOME"] = folder
    tools = ctypes.CDLL("libtooldata.so.0", mode=ctypes.RTLD_GLOBAL)
    status = ctypes.create_string_buffer(1 << 16)
    tools._Z17tool_mmap_creatorPK13EMC_TOOL_STATi(status, 0)
    tools._Z13tooldata_initb(False)
    tools._Z13tooldata_loadPKcPPc(table.encode(), None)


def tools_of(table):
    """All tools of the table as the interpreter asks for them: number, nine offsets, diameter."""
    tools = [(0,) + (0.0,) * 12 + (0,)]
    with open(table) as file:
        for line in file:
            words = {word[0]: float(word[1:]) for word in line.split()}
            offset = tuple(words.get(letter, 0.0) for letter in "XYZABCUVW")
            tools.append((int(words["T"]),) + offset + (words.get("D", 0.0), 0.0, 0.0, 0))
    return tools


def canon_class(tools):
    """The canon; its base class needs the module `gcode`, which needs the tool table."""
    from rs274.interpret import Translated

    class Canon(Translated):
        def __init__(self, parameter_file):
            self.parameter_file = parameter_file
            self.tool = (0.0,) * 9
            self.in_spindle = 0
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

        def change_tool(self, index):
            self.in_spindle = index

        def get_tool(self, index):
            # Index 0 is the spindle.
            index = index or self.in_spindle
            return tools[index] if index < len(tools) else (-1,) + (0.0,) * 12 + (0,)

    return Canon


def run(path, folder, table):
    """Reads one program and prints its moves."""
    load_tool_table(folder, table)
    import gcode

    parameters = os.path.join(folder, "parameters")
    open(parameters, "w").close()
    os.chdir(os.path.dirname(os.path.abspath(path)))
    result, line = gcode.parse(path, canon_class(tools_of(table))(parameters), "G21", "")
    if result > gcode.MIN_ERROR:
        print("@refused line", line, gcode.strerror(result).replace("\n", " "))
    else:
        print("@end")


table, *programs = map(os.path.abspath, sys.argv[1:])
for program in programs:
    print("@program", program, flush=True)
    with tempfile.TemporaryDirectory() as folder:
        child = os.fork()
        if child == 0:
            signal.alarm(SECONDS)
            try:
                run(program, folder, table)
            except BaseException as error:
                print("@refused", type(error).__name__, str(error).replace("\n", " "))
            sys.stdout.flush()
            os._exit(0)
        status = os.waitpid(child, 0)[1]
    if status != 0:
        print("\n@refused the process ended with status", status, flush=True)
