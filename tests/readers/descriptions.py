"""The parts that are exported and read back: every named case, parts whose files were once wrong
(`found`), and the corpus if PREMIO_CORPUS names its folder.
"""

import json
import os
import subprocess
from pathlib import Path

CASES = Path(__file__).parent.parent / "cases"
FOUND = Path(__file__).parent / "found"
# The program's exit status for a refused part, and for an invalid description.
REFUSED, UNREAD = 3, 2


def descriptions(folder):
    """Every description with its name; those of the corpus are trees in a table, and files."""
    for case in sorted(CASES.iterdir()):
        yield case.name, str(case / "model.padl")
    for path in sorted(FOUND.glob("*.padl")):
        yield path.stem, str(path)
    corpus = os.environ.get("PREMIO_CORPUS")
    if not corpus:
        print("PREMIO_CORPUS is not set: the corpus is skipped")
        return
    for path in sorted(Path(corpus).glob("openscad/*.csg")):
        yield path.name, str(path)
    for case in json.loads((Path(corpus) / "cases.json").read_text()):
        path = Path(folder) / f"{case['id']}.json"
        path.write_text(json.dumps(case["tree"]))
        yield case["id"], str(path)


def measures(premio, description):
    """What the program reports of a description; None if it has no solid to write."""
    known = subprocess.run([premio, "info", description, "--json"], capture_output=True, text=True)
    if known.returncode in (REFUSED, UNREAD):
        return None
    known = json.loads(known.stdout)
    return known if known["solids"] > 0 else None


def is_wrong(name, found, known):
    """Reports the faults found for a name. A known fault may or may not occur, because the result of
    another program can depend on the machine's arithmetic; its absence is only reported."""
    if name not in known:
        if found:
            print(f"{name}: {'; '.join(found)}")
        return bool(found)
    if not found:
        print(f"{name}: known to fail, and does not here ({known[name]})")
    return False
