# Reads an EDIF file with spydrnet, which shares nothing with our own reader, and prints what it
# found as one JSON document. Exits with 3 if this Python has no spydrnet.
import collections
import json
import sys

try:
    import spydrnet
except ImportError:
    sys.exit(3)

top = spydrnet.parse(sys.argv[1]).top_instance.reference


def name_in_file(thing):
    """The name that the file gives to a thing; `name` is the one before any renaming."""
    return thing["EDIF.identifier"]


def net(pin):
    """The name of the net at a pin."""
    return pin.wire.cable.name if pin.wire else None


def end(pin):
    """A pin as instance/port/bit, where bit 0 is the leftmost; the design has no instance name."""
    if isinstance(pin, spydrnet.InnerPin):
        instance, inner = "", pin
    else:
        instance, inner = name_in_file(pin.instance), pin.inner_pin
    return "/".join([instance, name_in_file(inner.port), str(bits[inner])])


bits = {
    pin: bit
    for cell in {top} | {instance.reference for instance in top.children}
    for port in cell.ports
    for bit, pin in enumerate(port.pins)
}
wires = [wire for cable in top.cables for wire in cable.wires]
found = {
    "ports": {port.name: [net(pin) for pin in port.pins] for port in top.ports},
    "cells": collections.Counter(instance.reference.name for instance in top.children),
    "nets": [" ".join(sorted(end(pin) for pin in wire.pins)) for wire in wires if wire.pins],
}
json.dump(found, sys.stdout)
