#!/usr/bin/python3
"""The user of a headless LinuxCNC: LinuxCNC starts it as its user interface (DISPLAY).

It records every servo period by halsampler to samples.txt, does what its environment variable WHAT
says with the program PROGRAM, and writes what came of it to result.json."""

import json
import os
import subprocess
import time

import linuxcnc

command, stat, errors = linuxcnc.command(), linuxcnc.stat(), linuxcnc.error_channel()
result = {"errors": [], "steps": []}

# LinuxCNC sends errors and other messages, such as those of (debug, ...), on one channel.
ERRORS = (linuxcnc.NML_ERROR, linuxcnc.OPERATOR_ERROR)


def look():
    stat.poll()
    message = errors.poll()
    while message:
        kind, text = message
        if kind in ERRORS:
            result["errors"].append(text.strip())
        message = errors.poll()


def until(condition, seconds, what):
    end = time.time() + seconds
    while True:
        look()
        if condition():
            return
        if time.time() > end:
            raise RuntimeError(f"not within {seconds} s: {what}")
        time.sleep(0.005)


def halcmd(*words):
    done = subprocess.run(["halcmd", *words], capture_output=True, text=True, check=True)
    return done.stdout.strip()


def pin(name):
    return halcmd("getp", "carrystep.0." + name)


def ready():
    return pin("connected") == "TRUE" and pin("fault") == "FALSE" and pin("joint.0.fault") == "FALSE"


def switch_on():
    command.state(linuxcnc.STATE_ESTOP_RESET)
    until(lambda: stat.task_state != linuxcnc.STATE_ESTOP, 5, "e-stop reset")
    until(ready, 5, "the board is ready")
    command.state(linuxcnc.STATE_ON)
    until(lambda: stat.task_state == linuxcnc.STATE_ON, 5, "machine on")


def mode(wanted):
    command.mode(wanted)
    command.wait_complete()


def begin(program):
    mode(linuxcnc.MODE_AUTO)
    command.program_open(program)
    command.auto(linuxcnc.AUTO_RUN, 0)
    until(lambda: stat.interp_state != linuxcnc.INTERP_IDLE, 5, program + " begins")


def moving():
    return max(abs(joint["velocity"]) for joint in stat.joint[:3]) > 5


def idle():
    return stat.interp_state == linuxcnc.INTERP_IDLE and stat.inpos


def finish(program, seconds):
    until(lambda: idle() or stat.task_state != linuxcnc.STATE_ON, seconds, program + " ends")
    if stat.task_state != linuxcnc.STATE_ON:
        raise RuntimeError(program + ": the machine is off, fault " + pin("fault-code"))


def home(seconds):
    until(ready, 10, "the board is ready")
    switch_on()
    mode(linuxcnc.MODE_MANUAL)
    command.home(-1)
    until(lambda: all(stat.homed[:3]), seconds, "homed")


def off():
    time.sleep(0.3)
    result["reserve_min_ms"] = float(pin("reserve-min-ms"))
    result["trim_ppm"] = float(pin("trim-ppm"))
    command.state(linuxcnc.STATE_OFF)
    time.sleep(0.3)


def program():
    home(10)
    name = os.environ["PROGRAM"]
    begin(name)
    finish(name, 1200)
    off()


def cases():
    home(10)
    first = os.environ["PROGRAM"]
    begin(first)
    finish(first, 60)

    begin(first)
    until(moving, 5, "motion")
    command.auto(linuxcnc.AUTO_PAUSE)
    until(lambda: stat.current_vel == 0, 5, "a pause rests")
    time.sleep(0.3)
    command.auto(linuxcnc.AUTO_RESUME)
    finish(first, 60)
    result["steps"].append("feed hold")

    begin(first)
    until(moving, 5, "motion")
    command.abort()
    until(idle, 5, "an abort rests")
    result["steps"].append("abort")

    mode(linuxcnc.MODE_MANUAL)
    command.teleop_enable(1)
    command.wait_complete()
    command.jog(linuxcnc.JOG_CONTINUOUS, False, 1, 20)
    time.sleep(0.4)
    command.jog(linuxcnc.JOG_STOP, False, 1)
    time.sleep(0.4)
    command.jog(linuxcnc.JOG_INCREMENT, False, 0, -30, 3)
    time.sleep(0.6)
    result["steps"].append("jog")

    begin(first)
    until(moving, 5, "motion")
    command.state(linuxcnc.STATE_ESTOP)
    until(lambda: stat.task_state == linuxcnc.STATE_ESTOP, 5, "e-stop")
    until(ready, 5, "the board rests")
    time.sleep(0.2)
    result["steps"].append("e-stop in motion")

    switch_on()
    begin(first)
    finish(first, 60)
    off()


def mdi(line, seconds):
    mode(linuxcnc.MODE_MDI)
    command.mdi(line)
    time.sleep(0.1)
    until(idle, seconds, line)


def motor_offset():
    """Motor place less joint place of joint 0, mm."""
    names = ["joint.0.motor-pos-cmd", "joint.0.pos-cmd"]
    motor, joint = [float(halcmd("getp", name)) for name in names]
    return motor - joint


def home_and_probe():
    home(60)
    until(lambda: idle() and stat.current_vel == 0, 20, "rest behind homing")
    time.sleep(0.5)
    # The coordinate of the switch is 0.
    result["home_steps"] = motor_offset() * 80
    command.teleop_enable(1)
    command.wait_complete()
    mdi("G21 G90 G94", 5)
    mdi("G0 X55", 20)
    mdi("M64 P0", 5)
    time.sleep(0.5)
    mdi("G38.2 X100 F300", 30)
    stat.poll()
    if not stat.probe_tripped:
        raise RuntimeError("the probe was not met")
    result["probed_steps"] = (stat.probed_position[0] + motor_offset()) * 80
    time.sleep(0.5)
    mdi("G0 X40", 20)
    mdi("M65 P0", 5)
    time.sleep(0.5)
    off()


def home_on_index():
    home(60)
    until(lambda: idle() and stat.current_vel == 0, 20, "rest behind homing")
    time.sleep(0.5)
    # The coordinate of the index pulse is 0.
    result["home_steps"] = motor_offset() * 80
    off()


def killed():
    home(10)
    begin(os.environ["PROGRAM"])
    until(moving, 5, "motion")
    open("kill", "w").close()
    for _ in range(500):
        if os.path.exists("killed"):
            break
        time.sleep(0.02)
    time.sleep(1)


def look_at_it():
    until(ready, 20, "the board is ready")
    time.sleep(0.3)
    for joint in range(3):
        result[f"feedback_{joint}"] = float(pin(f"joint.{joint}.position-fb"))


what = os.environ["WHAT"]
work = {
    "program": program,
    "cases": cases,
    "home_and_probe": home_and_probe,
    "home_on_index": home_on_index,
    "killed": killed,
    "look": look_at_it,
}
samples = open("samples.txt", "w")
sampler = subprocess.Popen(["stdbuf", "-oL", "halsampler", "-t"], stdout=samples)
try:
    work[what]()
    result["whole"] = True
except Exception as error:
    look()
    result["whole"] = False
    result["failed"] = str(error)
finally:
    if what != "killed":
        result["fault"] = int(pin("fault-code"))
        result.setdefault("reserve_min_ms", float(pin("reserve-min-ms")))
        result["servo_pause_ms"] = float(pin("servo-pause-ms"))
        result["thread_pause_ms"] = float(pin("thread-pause-ms"))
    sampler.terminate()
    sampler.wait()
    with open("result.json", "w") as file:
        json.dump(result, file, indent=1)
