"""The paper's table, remade: how much of the search for correspondences is pruned.

For two parts, Cube3Cut and Fork, the paper (SPARCstation 2, 1992) reports the number of
correspondences found, and the numbers of paths that its search opens and prunes. Its parts are
known by name and by figure only, so the dimensions here are our own. Its pictures are not known
either. The pictures here are by POV-Ray, with the lens, the point spread and the noise of
`sensor.py`, and with cameras and lights as in `povray.py`.

The search differs, too. The paper's search has no initial pose: its paths assign lines of the whole
picture. Ours assigns at a pose. Chains of lines propose thousands of poses, and the likeliest are
snapped to edges. At each remaining pose the correspondences of the features visible there are
searched. The paths reported are those of the best pose. The number of proposed poses is reported in
addition, because they are a part of the work.

A pose is right if it is within 2 % of the part's size (the diagonal of its box) and 2 degrees of
the true pose, or of one that the part's symmetries make equal to it. Whether it is also accepted
(found) is reported separately. Correspondences are features that are not missed. The right ones are
those at a right pose whose edge is within 2 pixels of the contour. Their recall is their share of
the features visible there, averaged over all pictures, and zero where the pose is wrong. Some
features are in no picture, because both their faces are equally dark. Therefore the share of
visible edges that `premio compare` finds with the same detector at the true pose is reported, too.
"""

import argparse
import sys
import tempfile
from dataclasses import dataclass, replace
from pathlib import Path

import numpy
import tables
from find import Program, error
from povray import PARTS, Studio
from setups import AWAY, LIT_FROM, Conditions, Setup, setups

# In the part's size, and in degrees.
RIGHT = (0.02, 2.0)
# In pixels.
BESIDE = 2.0
VIEWS, LIGHTS = 150, 3
# A picture's darkest faces have the level 0, and what is behind 31: with no ambient light none of the
# part's own levels is that of the background but by chance.
DETECTOR = "mask = { gaussian = { sigma = 1.0 } }\nthreshold = 4\nlow = 1.5\nshortest = 10\n"
STRATEGIES = ("bounded", "deepening", "stepped")


@dataclass
class Published:
    """What the paper says of its part."""

    name: str
    correspondences: int
    opened: int
    pruned: int
    seconds: float


PAPER = {
    "cube3cut": Published("Cube3Cut", 11, 51, 29, 1.75),
    "fork": Published("Fork", 10, 196, 126, 2.9),
}


@dataclass
class Searched:
    """A picture that was searched: what was found, and how far off it is."""

    found: dict
    off: tuple[float, float]

    @property
    def accepted(self) -> bool:
        return self.found["found"]

    @property
    def right(self) -> bool:
        return all(o <= r for o, r in zip(self.off, RIGHT))

    @property
    def correspondences(self) -> int:
        return sum(f["state"] != "missed" for f in self.found["features"])

    @property
    def recall(self) -> float:
        features = self.found["features"]
        near = sum(f["offset"] is not None and abs(f["offset"]) <= BESIDE for f in features)
        return near / max(len(features), 1) if self.right else 0.0


class Bench:
    """A part with its model and its pictures."""

    def __init__(self, premio: str, path: Path, folder: Path, fine: int):
        self.studio = Studio(premio, path, folder, fine)
        self.studio.conditions = replace(Conditions(), detector=DETECTOR)
        self.program = Program(premio, folder, [])
        self.middle = self.studio.bounds.mean(axis=0)
        self.size = float(numpy.linalg.norm(self.studio.bounds[1] - self.studio.bounds[0]))
        self.model = self.program.learned(path, self.conditions.toml(1, self.spheres()))
        self.pictures: list[Path] = []
        self.truths: list[numpy.ndarray] = []
        self.features: list[dict] = []
        self.k: list[float] = []

    @property
    def conditions(self) -> Conditions:
        return self.studio.conditions

    def spheres(self) -> str:
        def sphere(name: str, count: int, span: tuple[float, float]) -> str:
            return f"[{name}]\ncount = {count}\nradius = {0.5 * self.size * sum(span) / 2!r}\n"

        return sphere("viewing", VIEWS, AWAY) + sphere("illumination", LIGHTS, LIT_FROM)

    def photograph(self, known: list[Setup]) -> None:
        """The pictures, their true poses, and how much of what is visible the detector finds."""
        for i, setup in enumerate(known):
            at = self.studio.picture(setup)
            written = self.studio.written(setup, self.conditions)
            self.features += tables.compare(self.program.premio, self.studio.path, written, at)
            self.pictures.append(at.rename(at.with_name(f"{self.studio.path.stem}-{i:02}.png")))
            view = setup.camera(self.conditions)
            truth = numpy.eye(4)
            truth[:3, :3], truth[:3, 3] = view.r, view.t
            self.truths.append(truth)
        self.k = [view.k[0, 0], view.k[1, 1], view.k[0, 2], view.k[1, 2]]

    def there(self) -> tuple[int, int]:
        """Of the visible edges and limbs of all pictures, how many the detector finds."""
        form = [f for f in self.features if f["source"]["kind"] in ("edge", "limb")]
        return sum(f["found"] != "missed" for f in form), len(form)

    def searched(self, strategy: str, uniform: bool) -> list[Searched]:
        options = ["--strategy", strategy, *(["--uniform"] if uniform else [])]
        every = self.program.match(self.model, self.k, self.pictures, options)
        return [Searched(found, self.off(found, truth)) for found, truth in zip(every, self.truths)]

    def off(self, found: dict, truth: numpy.ndarray) -> tuple[float, float]:
        if "R" not in found:
            return float("inf"), float("inf")
        middle, degrees = error(found, truth, self.middle)
        return middle / self.size, degrees


HEAD = (
    "| part | search | predictions | pictures | pose right | of them found | found, wrong | off, % of size | ° | correspondences "
    "| recall | poses proposed | choices eliminated | paths opened | pruned | pruned, % | rounds | nodes | s |\n"
    "|---|---|---|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|"
)


def row(name: str, strategy: str, uniform: bool, all_of_them: list[Searched]) -> str:
    right = [s for s in all_of_them if s.right]
    wrong = [s for s in all_of_them if s.accepted and not s.right]

    def median(values, digits: int = 0) -> str:
        values = list(values)
        return f"{numpy.median(values):.{digits}f}" if values else "-"

    work = [s.found["work"] for s in all_of_them]
    cells = [
        name,
        strategy,
        "without" if uniform else "with",
        str(len(all_of_them)),
        str(len(right)),
        str(sum(s.accepted for s in right)),
        str(len(wrong)),
        median((100 * s.off[0] for s in right), 2),
        median((s.off[1] for s in right), 2),
        median(s.correspondences for s in right),
        f"{numpy.mean([s.recall for s in all_of_them]):.2f}",
        median(w["proposed"] for w in work),
        median(w["eliminated"] for w in work),
        median(w["opened"] for w in work),
        median(w["pruned"] for w in work),
        median((100 * w["pruning"] for w in work), 2),
        median(w["rounds"] for w in work),
        median(w["nodes"] for w in work),
        median((sum(s.found["seconds"].values()) for s in all_of_them), 2),
    ]
    return f"| {' | '.join(cells)} |"


def paper(of: Published) -> str:
    pruned = f"{100 * of.pruned / of.opened:.2f}"
    cells = [f"{of.name}, the paper", "", "with", *[""] * 6, str(of.correspondences), "", "", ""]
    return f"| {' | '.join([*cells, str(of.opened), str(of.pruned), pruned, '', '', str(of.seconds)])} |"


def failed(strategy: str, uniform: bool, all_of_them: list[Searched]) -> list[str]:
    """The pictures in which the part is not found, or elsewhere, and how far off."""
    told = []
    for s in all_of_them:
        if not (s.accepted and s.right):
            said = "found" if s.accepted else "not found"
            name = Path(s.found["image"]).name
            how = f"{strategy}, {'without' if uniform else 'with'}"
            told.append(f"<!-- {name} ({how}): {said}, {100 * s.off[0]:.1f} %, {s.off[1]:.1f}° -->")
    return told


def kept(bench: Bench, keep: Path | None) -> None:
    """The model, the pictures and the camera, to look into."""
    if keep is None:
        return
    keep.mkdir(parents=True, exist_ok=True)
    for path in [bench.model, *bench.pictures, bench.program.folder / "camera.json"]:
        (keep / path.name).write_bytes(path.read_bytes())


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("premio")
    parser.add_argument("--setups", type=int, default=12, help="pictures of each part")
    parser.add_argument("--fine", type=int, default=4, help="lines of sight on a side of a pixel")
    parser.add_argument("--only", default="", help="parts whose name contains this")
    parser.add_argument("--keep", type=Path, help="where to leave models, pictures, the camera")
    given = parser.parse_args()
    rows, there, notes = [], [], []
    for number, (stem, published) in enumerate(PAPER.items()):
        if given.only not in stem:
            continue
        with tempfile.TemporaryDirectory() as folder:
            bench = Bench(given.premio, PARTS / f"{stem}.json", Path(folder), given.fine)
            bench.photograph(setups(bench.studio.bounds, given.setups, seed=number + 1))
            rows.append(paper(published))
            for uniform in (False, True):
                for strategy in STRATEGIES:
                    all_of_them = bench.searched(strategy, uniform)
                    rows.append(row(published.name, strategy, uniform, all_of_them))
                    notes += failed(strategy, uniform, all_of_them)
            there.append("{}: {} of {}".format(published.name, *bench.there()))
            kept(bench, given.keep)
    print("## The paper's table, remade\n")
    print("The parts' dimensions are ours. The paper's search has no pose to start from; ours searches")
    print("correspondences at poses that chains of lines propose, so paths are not the same thing.")
    print("Numbers are medians: errors and correspondences of right poses, others of all pictures. Recall")
    print("is a mean.\n")
    print("\n".join([HEAD, *rows, *notes]))
    print(f"\nVisible edges that the detector finds at the true pose: {'; '.join(there)}\n")
    return 0


if __name__ == "__main__":
    sys.exit(main())
