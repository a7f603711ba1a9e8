"""Refits the weights of a match's score, and reports on pictures that the fit did not see.

Parts are searched in pictures with known poses, and in pictures that do not show them:

- the sets of `find.py`, where a pose is known: exactly, or for the tea box by the other camera;
- pictures by POV-Ray of the parts of `povray.py`, each with its own model.

Every search gives the likeliest match, right or wrong, with what it is scored by (`measures` of
`premio match --explain`). The probability of a match is a function of these measures and of the
weights (`probability` below is `ScoreWeights` in the program, and a check compares the two). The fit
maximises the likelihood of the labels, with a penalty on the logarithm of each weight's change, so
that a weight about which the pictures say nothing stays. Every set of pictures has the same total
weight in it, because the pictures of a sequence are alike.

Sets of pictures are divided into two halves. Weights that were fitted to one half are judged on the
other. The strength of the penalty is chosen within the half of the fit, by leaving out one set in
turn. `--write` writes the weights fitted to the first half, if they are better on the second.
"""

import argparse
import json
import os
import sys
import tempfile
import tomllib
from dataclasses import asdict, dataclass
from pathlib import Path

import find
import numpy
from povray import parts
from remade import Bench
from scipy.optimize import minimize
from setups import setups

WEIGHTS = Path(__file__).parents[2] / "match/src/verification/score_weights.toml"
# These determine whether a pose is looked at, and are not fitted.
FIXED = {"min_features", "min_features_of_revolution", "min_pose_information", "min_length"}
# Log-odds, which may have either sign: fitted by their difference, in these units.
ODDS = {"prior_odds": 5.0, "subpart_odds": 5.0}
# Shares of the whole.
SHARES = {"usual_share", "relief"}
# The candidates for the strength of the penalty.
PENALTIES = (0.003, 0.03, 0.3)
# The smallest likelihood of a label: one label may be wrong.
FLOOR = 1e-6

Weights = dict[str, float]


@dataclass
class Search:
    """The likeliest match of a part in a picture, and whether it is right."""

    group: str
    name: str
    right: bool
    measures: dict
    shape: dict
    ratio: float
    odds: float
    probability: float


def search(group: str, part: str, report: dict, right: bool) -> Search | None:
    if report.get("measures") is None:
        return None
    name = f"{part} in {Path(report['image']).name}"
    kept = {key: report[key] for key in ("measures", "shape", "ratio", "odds", "probability")}
    return Search(group, name, right, **kept)


# The searches.


def real(premio: str, images: Path, folder: Path) -> list[Search]:
    """The sets of `find.py`. Matches in pictures without a pose are left out."""
    made: list[Search | None] = []
    program = find.Program(premio, folder, ["--explain"])
    for part in find.PARTS:
        model = program.model(part)
        for other in find.PARTS:
            first = next(p for p in find.PARTS if p.folder == other.folder)
            if other is not first or other.folder in part.alike:
                continue
            by_camera = {}
            for camera, (k, pattern) in other.cameras.items():
                by_camera[camera] = program.match(model, k, sorted((images / other.folder).glob(pattern)))
            if other.folder != part.folder:
                frames = [f for every in by_camera.values() for f in every]
                made += [search(other.folder, part.name, f, False) for f in frames]
            else:
                made += own(part, by_camera, images / part.folder)
    return [s for s in made if s is not None]


def own(part: find.Sought, by_camera: dict[str, list[dict]], folder: Path) -> list[Search | None]:
    """Matches of a part in its own pictures, where the pose is known."""
    if part.folder == "teabox_stereo":
        return stereo(part, by_camera, folder)
    made = []
    for frames in by_camera.values():
        for frame, truth in zip(frames, find.truths(part, folder, frames)):
            if truth is not None and "R" in frame:
                right = find.is_right(find.error(frame, truth, part.middle))
                made.append(search(part.folder, part.name, frame, right))
    return made


def stereo(part: find.Sought, by_camera: dict[str, list[dict]], folder: Path) -> list[Search | None]:
    """Two independent matches that agree through the known extrinsic are both right. Where they do
    not, one of them is wrong, and it is not known which: both are left out."""
    extrinsic = numpy.loadtxt(folder / "cRightMcLeft.txt")
    extrinsic[3] = [0, 0, 0, 1]
    extrinsic = find.metres(extrinsic)
    made = []
    for left, right in zip(by_camera["left"], by_camera["right"]):
        if "R" not in left or "R" not in right:
            continue
        if find.is_right(find.error(right, extrinsic @ find.pose(left), part.middle)):
            made += [search(part.folder, part.name, frame, True) for frame in (left, right)]
    return made


def rendered(premio: str, folder: Path, count: int) -> list[Search]:
    """Pictures by POV-Ray: the own part is right where its pose is, every other one is wrong."""
    benches: dict[str, Bench] = {}
    for number, (name, path) in enumerate(parts(folder)):
        home = folder / f"bench-{number}"
        home.mkdir()
        bench = Bench(premio, path, home, 2)
        bench.program.options = ["--explain"]
        bench.photograph(setups(bench.studio.bounds, count, seed=100 + number))
        benches[name] = bench
        print(f"{name}: {len(bench.pictures)} pictures", file=sys.stderr, flush=True)
    made: list[Search | None] = []
    for name, bench in benches.items():
        for there, pictures in benches.items():
            frames = bench.program.match(bench.model, pictures.k, pictures.pictures)
            for frame, truth in zip(frames, pictures.truths):
                off = bench.off(frame, truth) if there == name else (numpy.inf, numpy.inf)
                right = off[0] <= 0.02 and off[1] <= 2.0
                made.append(search(f"povray {there}", name, frame, right))
    return [s for s in made if s is not None]


# The score, as the program computes it.


class Table:
    """The measures of many searches, by column."""

    def __init__(self, searches: list[Search]):
        self.searches = searches
        self.right = numpy.array([s.right for s in searches])
        self.offsets = [
            numpy.array([[o["offset"], o["roughness"]] for o in s.measures["offsets"]]).reshape(-1, 2)
            for s in searches
        ]
        # The offsets of all searches in one array, with the search of each.
        self.all_offsets = numpy.concatenate(self.offsets)
        self.owner = numpy.repeat(numpy.arange(len(searches)), [len(o) for o in self.offsets])
        self.counts = numpy.maximum([len(o) for o in self.offsets], 1)
        self.groups = numpy.array([s.group for s in searches])

    def column(self, name: str) -> numpy.ndarray:
        return numpy.array([float(s.measures[name]) for s in self.searches])

    def shape(self, name: str) -> numpy.ndarray:
        return numpy.array([float(s.shape[name]) for s in self.searches])

    def __getattr__(self, name: str) -> numpy.ndarray:
        # Columns are made once.
        values = self.shape(name) if name in ("determined", "undetermined") else self.column(name)
        setattr(self, name, values)
        return values


def positive(values: numpy.ndarray) -> numpy.ndarray:
    return numpy.maximum(values, sys.float_info.min)


def rough(w: Weights, t: Table) -> numpy.ndarray:
    contours, lines = (numpy.maximum(v, w["min_residual"]) for v in (t.rms, t.straightness))
    return numpy.maximum(numpy.log(contours / lines), 0)


def systematic_offset(w: Weights, t: Table) -> numpy.ndarray:
    offset, roughness = (t.all_offsets + w["offset_floor"]).T
    bound = w["max_systematic_offset"]
    times = numpy.clip(numpy.log(offset / roughness), -bound, bound)
    return numpy.bincount(t.owner, times, len(t.searches)) / t.counts


def figure(w: Weights, t: Table) -> numpy.ndarray:
    span = w["solid_shape"] - w["figure_shape"]
    return numpy.clip((t.column("shape") - w["figure_shape"]) / span, 0, 1)


def ratio(w: Weights, t: Table) -> numpy.ndarray:
    many = numpy.minimum(w["usual_features"] / t.features, 1)
    return (
        w["evidence_scale"] * numpy.log1p(numpy.maximum(t.evidence, 0) / w["evidence_scale"])
        + numpy.minimum(t.evidence, 0)
        + w["missing_features"] * many * t.against
        + w["missing_relations"] * t.unrelated
        + w["share"] * (t.share - w["usual_share"])
        - w["roughness"] * rough(w, t)
    )


def odds(w: Weights, t: Table) -> numpy.ndarray:
    length = numpy.clip(t.share * t.length / w["sufficient_length"], sys.float_info.min, 1)
    shape, bound, is_figure = t.column("shape"), w["max_shape"], figure(w, t)
    flat = 1 - numpy.minimum(numpy.maximum(t.relief / w["relief"], is_figure), 1)
    return (
        w["prior_odds"]
        - w["roughness_odds"] * rough(w, t)
        - w["systematic_offset"] * systematic_offset(w, t)
        + w["in_frame"] * numpy.log(positive(t.inside))
        - w["missed"] * t.missed
        + w["shortness"] * numpy.log(length)
        - w["overrun"] * t.overrun
        + w["shape"] * (numpy.clip(shape, -bound, bound) - bound)
        + w["carriers"] * numpy.log(positive(t.carriers))
        - w["flat"] * flat
        - w["axis_alignment"] * t.framed * (1 - is_figure)
    )


def whole(w: Weights, t: Table) -> numpy.ndarray:
    return w["subpart_odds"] + t.determined / w["subpart_shape"] + t.undetermined


def probability(w: Weights, t: Table) -> numpy.ndarray:
    log_odds = numpy.minimum((ratio(w, t) + odds(w, t)) / w["evidence_tempering"], whole(w, t))
    return 1 / (1 + numpy.exp(-numpy.clip(log_odds, -500, 500)))


def accepted(w: Weights, t: Table) -> numpy.ndarray:
    return (ratio(w, t) + odds(w, t) >= 0) & (whole(w, t) >= 0)


def verify(w: Weights, t: Table) -> None:
    """The functions above against the program's values."""
    for name, ours in (("ratio", ratio(w, t)), ("odds", odds(w, t)), ("probability", probability(w, t))):
        theirs = numpy.array([getattr(s, name) for s in t.searches])
        off = numpy.abs(ours - theirs) / numpy.maximum(numpy.abs(theirs), 1)
        worst = int(numpy.argmax(off))
        if off[worst] > 1e-9:
            which = f"{t.searches[worst].name}: {ours[worst]} here, {theirs[worst]} in the program"
            raise SystemExit(f"the {name} is not the program's: {which}")


# The fit.


def loss(w: Weights, t: Table) -> float:
    """The mean negative log-likelihood of the labels: in each set of pictures of the right and of the
    wrong matches, and of these means."""
    p = numpy.clip(probability(w, t), FLOOR, 1 - FLOOR)
    each = -numpy.log(numpy.where(t.right, p, 1 - p))
    means = []
    for group in numpy.unique(t.groups):
        for right in (True, False):
            of = (t.groups == group) & (t.right == right)
            if of.any():
                means.append(each[of].mean())
    return float(numpy.mean(means))


def moved(start: Weights, names: list[str], by: numpy.ndarray) -> Weights:
    w = dict(start)
    for name, x in zip(names, by):
        w[name] = start[name] + ODDS[name] * x if name in ODDS else start[name] * float(numpy.exp(x))
        if name in SHARES:
            w[name] = min(w[name], 1.0)
    return w


def fitted(start: Weights, t: Table, penalty: float) -> Weights:
    names = [name for name in start if name not in FIXED]

    def cost(by: numpy.ndarray) -> float:
        w = moved(start, names, by)
        # A figure's evidence must lie below a solid's.
        if w["solid_shape"] <= 1.05 * w["figure_shape"]:
            return 1e3
        return loss(w, t) + penalty * float(by @ by)

    result = minimize(cost, numpy.zeros(len(names)), method="L-BFGS-B", options={"maxiter": 200})
    return moved(start, names, result.x)


def chosen_penalty(start: Weights, searches: list[Search]) -> float:
    """The penalty with the least loss in sets that were left out in turn."""
    groups = sorted({s.group for s in searches})

    def left_out(penalty: float) -> float:
        losses = []
        for group in groups:
            w = fitted(start, Table([s for s in searches if s.group != group]), penalty)
            losses.append(loss(w, Table([s for s in searches if s.group == group])))
        return float(numpy.mean(losses))

    return min(PENALTIES, key=left_out)


# The report.


def row(what: str, weights: str, w: Weights, searches: list[Search]) -> str:
    t = Table(searches)
    yes = accepted(w, t)
    right, wrong = int(t.right.sum()), int((~t.right).sum())
    cells = [
        what,
        weights,
        f"{int((yes & t.right).sum())} of {right}",
        f"{int((yes & ~t.right).sum())} of {wrong}",
        f"{loss(w, t):.3f}",
    ]
    return f"| {' | '.join(cells)} |"


def refit(current: Weights, halves: list[list[Search]]) -> tuple[list[str], list[Weights]]:
    rows, both = [], []
    for fit, other, name in ((0, 1, "first"), (1, 0, "second")):
        penalty = chosen_penalty(current, halves[fit])
        w = fitted(current, Table(halves[fit]), penalty)
        both.append(w)
        label = f"fitted to the {name} half (penalty {penalty})"
        for half, seen in ((fit, "seen"), (other, "not seen")):
            what = f"{('first', 'second')[half]} half, {seen}"
            rows += [row(what, "current", current, halves[half]), row(what, label, w, halves[half])]
    return rows, both


def written(w: Weights, text: str) -> str:
    """The file of the weights with new values; comments and fixed values stay."""
    lines = []
    for line in text.splitlines():
        name = line.split("=")[0].strip()
        lines.append(f"{name} = {round(w[name], 4)!r}" if name in w and name not in FIXED else line)
    return "\n".join(lines) + "\n"


HEAD = "| pictures | weights | right ones accepted | wrong ones accepted | loss |\n|---|---|--:|--:|--:|"


def searched(premio: str, count: int) -> list[Search]:
    with tempfile.TemporaryDirectory() as folder:
        searches = rendered(premio, Path(folder), count)
        images = os.environ.get("PREMIO_IMAGES")
        if images:
            return searches + real(premio, Path(images), Path(folder))
        print("PREMIO_IMAGES is not set: photographs are passed over")
        return searches


def is_better(new: Weights, current: Weights, searches: list[Search]) -> bool:
    """Whether new weights have the smaller loss and accept no more wrong matches."""
    t = Table(searches)
    wrong = [int((accepted(w, t) & ~t.right).sum()) for w in (new, current)]
    return loss(new, t) < loss(current, t) and wrong[0] <= wrong[1]


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("premio")
    parser.add_argument("--setups", type=int, default=6, help="pictures of each rendered part")
    parser.add_argument("--searches", type=Path, help="read the searches from this file, or write them")
    parser.add_argument("--write", action="store_true", help="write the weights if they are better")
    given = parser.parse_args()
    text = WEIGHTS.read_text()
    current = tomllib.loads(text)
    if given.searches and given.searches.exists():
        searches = [Search(**s) for s in json.loads(given.searches.read_text())]
    else:
        searches = searched(given.premio, given.setups)
        if given.searches:
            given.searches.write_text(json.dumps([asdict(s) for s in searches]))
    verify(current, Table(searches))
    groups = sorted({s.group for s in searches})
    halves = [[s for s in searches if groups.index(s.group) % 2 == half] for half in (0, 1)]
    print("## The weights of a match's score, refitted\n")
    for half, name in enumerate(("first", "second")):
        print(f"The {name} half: {', '.join(groups[half::2])}.\n")
    rows, both = refit(current, halves)
    print("\n".join([HEAD, *rows]))
    print("\n| weight | current | fitted to the first half | fitted to the second half |")
    print("|---|--:|--:|--:|")
    for name in (name for name in current if name not in FIXED):
        print(f"| {name} | {current[name]} | " + " | ".join(f"{w[name]:.3g}" for w in both) + " |")
    better = is_better(both[0], current, halves[1])
    said = "better" if better else "not better: the current ones stay"
    print(f"\nOn the second half the weights fitted to the first are {said}.")
    if given.write and better:
        WEIGHTS.write_text(written(both[0], text))
        print(f"{WEIGHTS.name} is written.")
    return 0


if __name__ == "__main__":
    sys.exit(main())
