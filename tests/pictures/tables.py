"""Comparisons (`premio compare --json`, premio.comparison/1) of many pictures put together."""

import json
import subprocess
from collections.abc import Iterable
from pathlib import Path

STATES = ("whole", "broken", "missed")
BINS = 10
HEAD = (
    "| part | pictures | features | same state | Brier | all whole: same | Brier |\n"
    "|---|--:|--:|--:|--:|--:|--:|"
)


def compare(premio: str, part: Path, setup: Path, image: Path | None) -> list[dict]:
    """The features of one picture, predicted and found; the program renders it if none is given.

    Raises an error if the program does not take it.
    """
    command = [premio, "compare", str(part), "--setup", str(setup), "--json"]
    if image is not None:
        command += ["--image", str(image)]
    told = subprocess.run(command, capture_output=True, text=True)
    if told.returncode != 0:
        raise RuntimeError(f"{' '.join(command)}: {told.stderr.strip()}")
    return json.loads(told.stdout)["features"]


def brier(chances: dict, found: str) -> float:
    return sum((chances[state] - (state == found)) ** 2 for state in STATES)


def same(features: list[dict]) -> float:
    return sum(f["predicted"] == f["found"] for f in features) / max(len(features), 1)


def row(name: str, pictures: int, features: list[dict]) -> str:
    count = max(len(features), 1)
    score = sum(brier(f["chances"], f["found"]) for f in features) / count
    whole = sum(f["found"] == "whole" for f in features) / count
    cells = [f"{same(features):.3f}", f"{score:.3f}", f"{whole:.3f}", f"{2 * (1 - whole):.3f}"]
    return f"| {name} | {pictures} | {len(features)} | {' | '.join(cells)} |"


def kinds(features: list[dict]) -> str:
    """The same by what features are the image of: edges and limbs, and what lights draw."""
    light = [f for f in features if f["source"]["kind"] not in ("edge", "limb")]
    form = [f for f in features if f["source"]["kind"] in ("edge", "limb")]
    rows = [row("edges and limbs", 0, form), row("shadows and highlights", 0, light)]
    return "\n".join(r.replace("| 0 |", "| |", 1) for r in rows)


def states(features: list[dict]) -> str:
    """How often which state is predicted and found."""
    lines = ["| predicted | found whole | broken | missed |", "|---|--:|--:|--:|"]
    for state in STATES:
        found = [f["found"] for f in features if f["predicted"] == state]
        lines.append(f"| {state} | {' | '.join(str(found.count(s)) for s in STATES)} |")
    return "\n".join(lines)


def reliability(features: Iterable[dict]) -> str:
    """Of the features whose chance of being whole is predicted alike, how many are whole."""
    bins: list[list[tuple[float, bool]]] = [[] for _ in range(BINS)]
    for f in features:
        chance = f["chances"]["whole"]
        bins[min(int(chance * BINS), BINS - 1)].append((chance, f["found"] == "whole"))
    lines = ["| chance of whole | features | predicted | found |", "|---|--:|--:|--:|"]
    for i, held in enumerate(bins):
        if held:
            means = [sum(v[k] for v in held) / len(held) for k in (0, 1)]
            span = f"{i / BINS:.1f} to {(i + 1) / BINS:.1f}"
            lines.append(f"| {span} | {len(held)} | {means[0]:.3f} | {means[1]:.3f} |")
    return "\n".join(lines)
