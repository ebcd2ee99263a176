"""The table of what is left out, as a page of Markdown, from the records of `bench.skips`."""

from __future__ import annotations

COLUMNS = ("method", "left out", "when", "seen", "counter", "scene", "count", "ms", "ms without", "gain",
           "largest difference")  # fmt: skip

NOTES = """\
A rule is measured in a situation that gives it something to do, named under *seen*; where its counter stays at 0 the
scene had nothing of the kind, and the two times differ by what timing is worth here. *Largest difference* is of linear
light between the two pictures, over all pixels and channels.

* **Frames in focus.** The rule of thumb is half a pixel. Measured against the method itself it is not equal: at a CoC
  radius of 0.25 px the pictures differ by up to 0.05 (mipmap), 0.48 (multiview), 0.07 (layered) and 0.24 (pyramid) of
  white at single pixels, for those methods filter as little as that, and the reference changes by as much. So each
  method has the radius up to which its picture is the pinhole's (`SHARP_PX` in its module). Multiview's triangles come
  through a geometry shader, after which the rasteriser here interpolates a little differently: that is the difference
  in its row, at some 20 of 49,152 pixels. Drawn layer by layer (`layering = passes`) it is 1e-6.
* **Unchanged frames** draw nothing at all: the window renders when settings differ (`!=`) from those shown, and the
  progressive reference goes on adding views only until it vouches for its target. Exposure and tone curve are of the
  display and render nothing.
* **Kept images.** Pinhole picture, peels and layers depend on scene, camera and size, not on the lens or the method.
* **Hidden objects.** The reference asks once which pieces lie outside the union of all its frusta, not for each view.
* **Layers without surfaces** of the layered method cost nothing by themselves, as no tile has anything of them. What is
  left out are their small filters, whose blur goes to the next one's. A sum of Gaussians is a Gaussian only up to
  sampling and to where it is cut: with 24 layers pictures differ by up to 0.01 (`foreground` at 384x288; 0.02 was seen
  with filters far below a pixel). That is the one rule here that is not equal, and it is not switched by `--no-skip`.
  Discrete Gaussians, e⁻ᵗ·Iₙ(t) cut at 4σ + 2 texels, add up to one another exactly: with them it is 9e-7. But they have
  more of a tail where they are narrow, and those pictures are 0.6, 0.5 and 0.4 dB farther from the reference on
  `foreground`, `background` and `rail`, with half as many fetches again. So the filters stay as they are.
* **A converged reference** is not meant to be equal: it vouches for 45 dB, and the table has its PSNR against all 256
  views.
* No rule costs more than it saves: up to 20 frames each way were taken in turn, and where a rule finds little to leave
  out the two times are within the 2 % that timing is worth here. A test of boxes, masks or ranges is made once for a
  frame; the histogram and the content of cells are made once for a camera and kept.
"""


def skip_page(content: dict) -> str:
    """The page; `content` is what skips.json holds."""
    machine, size = content["machine"], "x".join(map(str, content["size"]))
    head = (
        f"# What a frame does not need\n\nMade by `dofview bench --skips --out docs/benchmark`: "
        f"{size}, mean CoC {content['mean_coc_px']:g} px unless a situation says otherwise, each with its method's own "
        f"lens. {machine['renderer']}, {machine['processor']}; medians of frames in turn, by the {content['clock']}'s "
        "clock.\n\n"
    )
    lines = ["| " + " | ".join(COLUMNS) + " |", "|" + "---|" * len(COLUMNS)]
    before = None
    for record in content["skips"]:
        rule = (record["method"], record["what"], record["when"], record["seen"].rstrip("."), f"`{record['counter']}`")
        shown = ("",) * len(rule) if rule == before else rule
        before = rule
        gain = f"{record['ms_without'] / record['ms']:.2f}" if record["count"] else "–"
        figures = (record["scene"], str(record["count"]), f"{record['ms']:.1f}", f"{record['ms_without']:.1f}", gain,
                   _difference(record))  # fmt: skip
        lines.append("| " + " | ".join((*shown, *figures)) + " |")
    return head + "\n".join(lines) + "\n\n" + NOTES


def _difference(record: dict) -> str:
    if "psnr" in record:
        return f"{record['psnr']:.1f} dB"
    return "0" if record["max_difference"] == 0.0 else f"{record['max_difference']:.0e}"
