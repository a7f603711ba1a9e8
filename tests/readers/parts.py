"""Parts that a person would model, as `premio fuzz --profile parts` makes them, written as STEP and
read back by OpenCASCADE: valid by its checker, and of one volume with the boundary, solid by solid.

usage: parts.py PREMIO [COUNT [FROM]]
"""

import json
import subprocess
import sys
import tempfile
from pathlib import Path

from OCP.BRepCheck import BRepCheck_Analyzer
from OCP.BRepGProp import BRepGProp
from OCP.GProp import GProp_GProps
from OCP.TopAbs import TopAbs_SOLID
from step import count, quiet, shape_in

# How many parts are tried where nothing is said: three minutes' worth.
COUNT = 400
# Volumes may differ by this part.
VOLUME = 1e-5


def written(premio, first, number, folder):
    """The manifest's lines of the parts of so many seeds, whose descriptions are in the folder."""
    command = [premio, "fuzz", "--profile", "parts", "--from", str(first), "--count", str(number)]
    command += ["--write", str(folder), "--rays", "1000", "--threads", "2"]
    subprocess.run(command, capture_output=True, check=True)
    lines = (Path(folder) / "manifest.jsonl").read_text().splitlines()
    return [json.loads(line) for line in lines]


def faults(premio, part, folder):
    """What is wrong with the STEP file of a part."""
    measures = part["measures"]
    out = Path(folder) / "out.step"
    out.unlink(missing_ok=True)
    description = Path(folder) / part["files"][0]["file"]
    command = [premio, "export", str(description), "--format", "step", "-o", str(out)]
    told = subprocess.run(command, capture_output=True, text=True)
    if told.returncode != 0:
        return [f"status {told.returncode}: {told.stderr.strip()}"]
    shape = shape_in(out)
    if shape is None:
        return ["not read"]
    found = [] if BRepCheck_Analyzer(shape).IsValid() else ["not valid"]
    properties = GProp_GProps()
    BRepGProp.VolumeProperties_s(shape, properties, VOLUME / 10)
    off = abs(properties.Mass() / measures["volume"] - 1)
    if off > VOLUME:
        found.append(f"a volume off by {off:.2g}")
    solids = count(shape, TopAbs_SOLID)
    if solids != measures["solids"]:
        found.append(f"{solids} solids, not {measures['solids']}")
    return found


def main():
    quiet()
    premio = sys.argv[1]
    number = int(sys.argv[2]) if len(sys.argv) > 2 else COUNT
    first = int(sys.argv[3]) if len(sys.argv) > 3 else 0
    read = wrong = empty = 0
    with tempfile.TemporaryDirectory() as folder:
        for part in written(premio, first, number, folder):
            if part["verdict"] != "right":
                print(f"parts {part['seed']}: {part['verdict']}")
                wrong += 1
                continue
            if part["measures"]["solids"] == 0:
                empty += 1
                continue
            read += 1
            found = faults(premio, part, folder)
            if found:
                wrong += 1
                print(f"parts {part['seed']}: {'; '.join(found)}")
    print(f"{read} parts read, {wrong} wrong; {empty} have nothing to write")
    return 1 if wrong or read == 0 else 0


if __name__ == "__main__":
    sys.exit(main())
