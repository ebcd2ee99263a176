"""What `layered` knows of the scene, its peels, and the picture made of them and of the two blurred buffers."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from dofview.gl.targets import Image
from dofview.methods.layered_plan import Layer
from dofview.methods.layered_regions import CELL, SLICES, Content, Window
from dofview.methods.method import Recipe
from dofview.render.frame import Surfaces

Color = tuple[float, float, float, float]

COMMON = 2
"""Peels that much of a picture has surfaces in; those behind them are looked at only in the tiles where they matter."""

NOTHING: Color = (0.0, 0.0, 0.0, 0.0)


class Peels:
    """What is known of the scene: colours and inverse depths of the peels, and where they are.

    `exhausted` says that no pixel has surfaces behind the last peel. `start` is what the paper's layers are in front
    of: the background, if it can be seen at all and nothing unknown can be in front of it; else it belongs to the
    farthest layer. `complete` says that there is nothing to be filled in.
    """

    def __init__(self, recipe: Recipe, peels: Sequence[Surfaces], exhausted: bool, *, paper: bool):
        self.recipe = recipe
        self.frame = recipe.frame
        visible = self.frame.depth_range().farthest == 0.0
        self.background: Color = (*self.frame.background, 1.0 if visible else 0.0)
        self.start = self.background if visible and exhausted and paper else NOTHING
        self.complete = exhausted and (paper or not visible)
        self.defines: dict[str, object] = {"PEELS": len(peels), **({"PAPER": 1} if paper else {})}
        self.depths = self._pack(peels)
        guard, size = self.frame.guard, self.frame.inner_size
        self.window = Window(guard, guard, guard + size[0], guard + size[1])
        self.colors = [surfaces.color for surfaces in peels]
        self.nearest = peels[0].inverse_depth
        self.sky: dict[str, Image] = {}
        self.content = self._content(visible and not (exhausted and paper))
        if visible and not paper:
            self.defines |= {"SKY": 1, "CELL": CELL, **({"EXHAUSTED": 1} if exhausted else {})}
            self.sky = {"sky_distance": self._sky_distance()}

    def draw(
        self, shader: str, into: Image, layer: Layer, *, values: dict | None = None, reach: float = 0.0,
        images: Mapping[str, Image] | None = None, peels: int | None = None, **how: Any,
    ) -> None:  # fmt: skip
        """Run a shader that includes `matte.glsl` for `layer`, whose filter reaches `reach` px; where no more than
        `peels` surfaces are behind one another, only they are looked at."""
        presence = {"PRESENCE": 1} if reach > 0.0 and "PAPER" not in self.defines else {}
        how["defines"] = {**self.defined(layer, peels), **presence, **how.get("defines", {})}
        values = {"start": self.start, **(values or {}), **self.values(layer)} | ({"reach": reach} if presence else {})
        textures = {**self.textures(layer, peels), **(images or {})}
        if presence:
            textures["depths_nearest"] = self.nearest
            how["samplers"] = {**how.get("samplers", {}), "depths_nearest": self.recipe.gpu.linear}
        self.recipe.draw(shader, into, values=values, images=textures, **how)

    def textures(self, layer: Layer, peels: int | None = None) -> dict[str, Image]:
        """What `matte.glsl` reads of the first `peels` surfaces, or of all."""
        count = len(self.colors) if peels is None else peels
        depths = {name: image for name, image in self.depths.items() if count > 4 or name != "depths_last"}
        colors = {f"color{m}": color for m, color in enumerate(self.colors[:count])}
        return colors | depths | (self.sky if layer.farthest else {})

    def defined(self, layer: Layer, peels: int | None = None) -> dict[str, object]:
        """Of the layers, only the farthest has to do with the background."""
        unused = () if layer.farthest else ("SKY", "EXHAUSTED")
        found = {name: value for name, value in self.defines.items() if name not in unused}
        return found if peels is None else found | {"PEELS": peels}

    def values(self, layer: Layer) -> dict[str, object]:
        width, height = self.frame.size
        pixel = (1.0 / width, 1.0 / height)
        return {"anchors": layer.anchors, "background": self.background, "pixel_size": pixel}

    def _pack(self, peels: Sequence[Surfaces]) -> dict[str, Image]:
        """Inverse depths of up to four peels in each texel."""
        count = len(peels)
        if count == 1:
            return {"depths_first": peels[0].inverse_depth}
        images = {
            "depths_first": self.recipe.image("depths_first", components=2 if count == 2 else 4),
            **({"depths_last": self.recipe.image("depths_last")} if count > 4 else {}),
        }
        held = [self.frame.cache.holds((self.frame.geometry_key, count), image) for image in images.values()]
        if not all(held):
            sources = {f"depth{m}": surfaces.inverse_depth for m, surfaces in enumerate(peels)}
            self.recipe.draw("depths.frag", list(images.values()), defines={"PEELS": count}, images=sources)
        return images

    def _sky_distance(self) -> Image:
        """How far each cell is from background that can be seen, px."""
        image = self.recipe.image("sky distance", self.content.shape[::-1], 1, linear=True)
        if not self.frame.cache.holds((self.frame.geometry_key, "sky distance"), image):
            image.write(self.content.sky_distance()[::-1, :, None])
        return image

    def _content(self, background_counts: bool) -> Content:
        """Where surfaces are, cell by cell. Read back once per geometry key."""
        count = len(self.colors)
        key = (self.frame.geometry_key, "layered content", count, background_counts)
        if key not in self.frame.cache.values:
            deep = self._content_of(COMMON, count, background_counts) if count > COMMON else None
            self.frame.cache.values[key] = self._content_of(0, min(count, COMMON), background_counts, deep)
        return self.frame.cache.values[key]  # type: ignore[return-value]

    def _content_of(
        self, first: int, to: int, background_counts: bool, deep: Content | None = None
    ) -> Content:  # fmt: skip
        """That of the peels from `first` up to, and without, `to`."""
        depths, size = self.frame.depth_range(), self.frame.size
        extent = depths.nearest - depths.farthest_surface
        slices = SLICES / extent if extent > 0.0 else 0.0
        shape = (-(-size[0] // CELL), -(-size[1] // CELL))
        images = [
            self.recipe.image("content", shape, dtype="u4"), self.recipe.image("content extremes", shape),
            self.recipe.image("content farthest", shape, 1),
        ]  # fmt: skip
        values = {"nearest": depths.nearest, "slices_per_depth": slices, "background_counts": background_counts}
        defines = {"CELL": CELL, "FIRST": first, "PEELS": to}
        self.recipe.draw("content.frag", images, defines=defines, values=values, images=self.depths)
        bits, extremes, farthest = (image.pixels()[::-1] for image in images)
        return Content(depths.nearest, slices, bits, extremes, farthest, deep)
