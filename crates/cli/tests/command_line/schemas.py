"""Reads one document a line, with the path of its schema, and prints what is wrong with it.

Asked:     {"schema": "/.../docs/schemas/plan.json", "document": {...}}
Answered:  ["moves/0: 'ticks' is a required property"], or [] if nothing is wrong
"""

import json
import sys

# A document names the draft of its schema; the module knows all of them.
from jsonschema import validators

known = {}


def validator(path):
    """The validator of this schema, which is read once."""
    if path not in known:
        with open(path) as file:
            schema = json.load(file)
        kind = validators.validator_for(schema)
        kind.check_schema(schema)
        known[path] = kind(schema)
    return known[path]


# The first line says that the module was found.
print("ready", flush=True)
for line in sys.stdin:
    asked = json.loads(line)
    wrong = []
    for error in validator(asked["schema"]).iter_errors(asked["document"]):
        place = "/".join(str(part) for part in error.absolute_path)
        wrong.append(f"{place}: {error.message}")
    print(json.dumps(wrong), flush=True)
