"""What the papers report of their methods, and whether these results reproduce it.

Absolute times belong to other machines and scenes; what is compared is PSNR, ratios within one run, and orderings.
"""

from __future__ import annotations

import statistics
from collections import Counter
from collections.abc import Callable
from dataclasses import dataclass
from typing import NamedTuple

from dofview.bench.pareto import quality
from dofview.bench.plan import FARTHEST, OWN, PAPER_SIZE, is_default, natural

Records = list[dict]
Read = Callable[[Records], float | None]


@dataclass(frozen=True)
class Claim:
    """A published figure, and how it is read off results: None when the results do not hold what it needs.

    `order` claims are of a difference whose sign counts; `most` of a figure that should not be larger. `otherwise` is
    the reason where it is not reproduced. Read are records of `size`, or of that which most have, seen with `focus` and
    with a `guard` band as wide.
    """

    source: str
    what: str
    published: float
    unit: str
    read: Read
    how: str
    otherwise: str = ""
    judged: str = "least"
    size: tuple[int, int] | None = None
    focus: str = OWN
    guard: int | None = None


class Verdict(NamedTuple):
    """A claim beside what was measured: "better", "reproduced" (within 3 %), "not" or "not measured", and why."""

    claim: Claim
    measured: float | None
    word: str
    reason: str


def verdict(claim: Claim, measured: float | None) -> Verdict:
    """Judge what was measured."""
    if measured is None:
        return Verdict(claim, None, "not measured", claim.how)
    if claim.judged == "order":
        word = "reproduced" if measured > 0.0 else "not"
    elif claim.judged == "most":
        word = "better" if measured < claim.published else "reproduced" if measured <= 1.03 * claim.published else "not"
    else:
        word = "better" if measured > claim.published * 1.03 else "reproduced"
        word = "not" if measured < claim.published * 0.97 else word
    reason = f"{claim.how}; {claim.otherwise}" if word == "not" and claim.otherwise else claim.how
    return Verdict(claim, measured, word, reason)


def _chosen(records: Records, **wanted: object) -> Records:
    return [r for r in records if all(r.get(name) == value for name, value in wanted.items())]


def _psnr(method: str, scene: str, coc: float, **parameters: object) -> Read:
    """PSNR of `method` on `scene` at mean CoC `coc`: its defaults, or the settings that have `parameters`."""

    def read(records: Records) -> float | None:
        found = _chosen(records, method=method, scene=scene, coc_px=coc)
        wanted = [
            r for r in found
            if (parameters.items() <= r["parameters"].items() if parameters else is_default(r))
        ]  # fmt: skip
        return max((quality(r) for r in wanted), default=None)

    return read


def _less(first: Read, second: Read) -> Read:
    """The difference of two figures."""

    def read(records: Records) -> float | None:
        one, other = first(records), second(records)
        return None if one is None or other is None else one - other

    return read


def _times(method: str, slower: str, **of: object) -> Read:
    """Time of `slower` over that of `method`, both with their defaults, median over scenes."""

    def read(records: Records) -> float | None:
        ratios = []
        for record in (r for r in _chosen(records, method=method, parameters={}, **of) if "@" not in r["scene"]):
            others = _chosen(records, method=slower, parameters={}, scene=record["scene"], size=record["size"], **of)
            ratios += [other["ms"] / record["ms"] for other in others[:1]]
        return statistics.median(ratios) if ratios else None

    return read


def _growth(method: str, small: float, large: float, per: str = "") -> Read:
    """Time at mean CoC `large` over that at `small`, of each of what the counter `per` counts; median over scenes."""

    def cost(record: dict) -> float:
        return record["ms"] / (record["counts"][per] if per else 1)

    def read(records: Records) -> float | None:
        ratios = []
        for record in _chosen(records, method=method, parameters={}, coc_px=small):
            same = {name: record[name] for name in ("scene", "size", "distribution")}
            others = _chosen(records, method=method, parameters={}, coc_px=large, **same)
            ratios += [cost(other) / cost(record) for other in others]
        return statistics.median(ratios) if ratios else None

    return read


def _speed_up(method: str, views: int, coc: float, scenes: tuple[str, ...] = ()) -> Read:
    """Time of accumulation with `views` over that of the method's default at mean CoC `coc`, median over `scenes`, or
    over all that are not cut finer or coarser.

    Accumulation's time is proportional to its views: that of the nearest number measured is scaled.
    """

    def read(records: Records) -> float | None:
        ratios = []
        for record in _chosen(records, method=method, coc_px=coc, parameters={}):
            if record["scene"] not in scenes if scenes else "@" in record["scene"]:
                continue
            others = _chosen(records, method="accumulation", coc_px=coc, scene=record["scene"], size=record["size"])
            if others:
                nearest = min(others, key=lambda r: abs(r["parameters"]["views"] - views))
                ratios.append(nearest["ms"] * views / nearest["parameters"]["views"] / record["ms"])
        return statistics.median(ratios) if ratios else None

    return read


FRONT, BACK = "demo:foreground", "demo:background"
SPLATTED, PEELED = (tuple(f"demo:{name}@{count}" for name in ("foreground", "background", "rail"))
                    for count in ("216k", "74k"))  # fmt: skip
ONE_SURFACE = (
    "the scene's beads are a few pixels wide and blur to many times that: with one surface a pixel what they hide is "
    "not there to be shown, and a mean CoC of 16 px over this scene is one of up to 130 px on the beads"
)

CLAIMS = (
    Claim("Lee, Kim, Choi 2008", "splatting with the hidden image", 36.33, "dB", _psnr("splatting", FRONT, 16.0),
          "foreground, mean CoC 16"),
    Claim("Lee, Kim, Choi 2008", "what the hidden image gains", 3.49, "dB",
          _less(_psnr("splatting", FRONT, 16.0, reduced_from=3.0), _psnr("splatting", FRONT, 16.0, hidden=False)),
          "foreground, mean CoC 16, with and without at the same reduction"),
    *(Claim("Lee, Kim, Choi 2008", f"over accumulation, mean CoC {coc}, {views} views", ratio, "times",
            _speed_up("splatting", views, float(coc), SPLATTED),
            f"{fps}; defaults, median of three scenes of 216,000 triangles at 1024×768, as there", size=PAPER_SIZE)
      for coc, views, ratio, fps in ((8, 24, 5.6, "67 over 12 fps"), (16, 96, 17.0, "50 over 3"),
                                     (32, 384, 44.0, "31 over 0.7"))),
    *(Claim("Lee, Kim, Choi 2008", f"the same with few triangles, mean CoC {coc}", ratio, "times",
            _speed_up("splatting", views, float(coc)), "defaults, median of three scenes at 512×384",
            "20,000 triangles here, 216,000 there, of which a view of the reference is made alone")
      for coc, views, ratio in ((8, 24, 5.6), (16, 96, 17.0), (32, 384, 44.0))),
    Claim("Lee, Eisemann, Seidel 2009", "multiview with 32 rays", 30.84, "dB", _psnr("multiview", FRONT, 16.0),
          "foreground, mean CoC 16"),
    Claim("Lee, Eisemann, Seidel 2009", "multiview above pyramid", 8.56, "dB",
          _less(_psnr("multiview", FRONT, 16.0), _psnr("pyramid", FRONT, 16.0)),
          "the order is judged; each through the lens it is made for", judged="order"),
    Claim("Lee, Eisemann, Seidel 2009", "multiview above mipmap", 11.31, "dB",
          _less(_psnr("multiview", FRONT, 16.0), _psnr("mipmap", FRONT, 16.0)), "the order is judged", judged="order"),
    Claim("Schedl, Wimmer 2012", "layered over accumulation of 256 views", 47.0, "times",
          _speed_up("layered", 256, 16.0, PEELED),
          "4809 over 102 ms; defaults, mean CoC 16, median of three scenes of 74,000 triangles at 1024×768",
          size=PAPER_SIZE),
    Claim("Schedl, Wimmer 2012", "the same with few triangles", 47.0, "times", _speed_up("layered", 256, 16.0),
          "defaults, mean CoC 16, median of three scenes at 512×384", "20,000 triangles here, 74,000 there"),
    Claim("Kraus, Strengert 2007", "growth of time over growth of sub-images", 1.02, "times",
          _growth("pyramid", 4.0, 64.0, per="pyramid sub-images"),
          "12 take 70.4 ms, 6 take 34.5; here growth of time over growth of their number, mean CoC 4 to 64, on a "
          "canvas of one size, as there", judged="most", guard=0),
    Claim("Kraus, Strengert 2007", "the same where the canvas grows", 1.02, "times",
          _growth("pyramid", 4.0, 64.0, per="pyramid sub-images"), "with a guard band as wide as the blur",
          "up to 128 px on each side, which blur in what is outside the picture", "most"),
    Claim("Lee, Kim, Choi 2009", "mipmap, background blur", 37.66, "dB", _psnr("mipmap", BACK, 16.0),
          "background, mean CoC 16"),
    *(Claim("Lee, Kim, Choi 2009", f"mipmap, foreground blur, mean CoC {coc:g}", 35.41, "dB",
            _psnr("mipmap", BACK, coc), "large things, the farthest wall in focus, as there", focus=FARTHEST)
      for coc in (8.0, 16.0)),
    Claim("Lee, Kim, Choi 2009", "the same with strings of beads", 35.41, "dB", _psnr("mipmap", FRONT, 16.0),
          "foreground, mean CoC 16", ONE_SURFACE),
    Claim("Lee, Kim, Choi 2009", "pyramid as measured there, background blur", 25.89, "dB",
          _psnr("pyramid", BACK, 16.0), "background, mean CoC 16; with the blur calibrated to the lens"),
    Claim("Lee, Kim, Choi 2009", "pyramid as measured there, foreground blur", 24.43, "dB",
          _psnr("pyramid", BACK, 16.0), "mean CoC 16, the farthest wall in focus", focus=FARTHEST),
    Claim("Lee, Kim, Choi 2009", "the same with strings of beads", 24.43, "dB",
          _psnr("pyramid", FRONT, 16.0), "foreground, mean CoC 16", ONE_SURFACE),
    Claim("Lee, Kim, Choi 2009", "mipmap above pyramid, background", 11.77, "dB",
          _less(_psnr("mipmap", BACK, 16.0), _psnr("pyramid", BACK, 16.0)), "the order is judged",
          "they had pyramid with its paper's constants; calibrated to the same lens it is the better one", "order"),
    Claim("Lee, Kim, Choi 2009", "mipmap above pyramid as it was printed, background", 11.77, "dB",
          _less(_psnr("mipmap", BACK, 16.0), _psnr("pyramid", BACK, 16.0, analysis="box4", blur="paper")),
          "the order is judged; its box filter, blur and matting, as they had it", judged="order"),
    Claim("Lee, Kim, Choi 2009", "mipmap faster than pyramid: 21 full-screen fetches to 173", 8.2, "times",
          _times("mipmap", "pyramid", coc_px=16.0), "defaults, mean CoC 16, whole frames",
          "both draw the scene first, which is a third to a half of mipmap's frame here; pyramid makes 6 to 12 fetches "
          "a sub-image instead of 21.6, for 4 to 8 of them, mipmap 37 or 44 in all"),
    Claim("Lee, Kim, Choi 2009", "mipmap at a mean CoC of 64 over 4 px", 1.0, "times", _growth("mipmap", 4.0, 64.0),
          "its fetches do not depend on the blur; on a canvas of one size, as there", judged="most", guard=0),
    Claim("Lee, Kim, Choi 2009", "the same where the canvas grows", 1.0, "times", _growth("mipmap", 4.0, 64.0),
          "with a guard band as wide as the blur", "up to 128 px on each side", "most"),
)  # fmt: skip


def verdicts(records: Records) -> list[Verdict]:
    """Every claim beside its measurement, through the lens that the method is made for and as the claim is made."""
    sizes = Counter(tuple(r["size"]) for r in records)
    natural_lens = [
        r for r in records if r["method"] == "accumulation" or r["distribution"] == natural(r["method"])
    ]  # fmt: skip

    def of(claim: Claim) -> Records:
        seen = (claim.size or sizes.most_common(1)[0][0], claim.focus, claim.guard)
        return [r for r in natural_lens if (tuple(r["size"]), r.get("focus", OWN), r.get("guard")) == seen]

    return [verdict(claim, claim.read(of(claim))) for claim in CLAIMS]
