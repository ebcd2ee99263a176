"""What `layered` knows of the scene, its peels, and the picture made of them and of the two blurred buffers."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from dofview.gl.pull_push import pull_push
from dofview.gl.targets import Image
from dofview.methods.layered_plan import FAR, Layer
from dofview.methods.layered_regions import CELL, SLICES, Content, Window
from dofview.methods.method import Recipe
from dofview.render.frame import Surfaces

Color = tuple[float, float, float, float]

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
        self.textures = {f"color{m}": surfaces.color for m, surfaces in enumerate(peels)} | self.depths
        self.nearest = peels[0].inverse_depth
        self.content = self._content(visible and not (exhausted and paper))
        if visible and not paper:
            self.defines |= {"SKY": 1, "CELL": CELL, **({"EXHAUSTED": 1} if exhausted else {})}
            self.textures["sky_distance"] = self._sky_distance()

    def draw(
        self, shader: str, into: Image, layer: Layer, *, values: dict | None = None, reach: float = 0.0,
        images: Mapping[str, Image] | None = None, **how: Any,
    ) -> None:  # fmt: skip
        """Run a shader that includes `matte.glsl` for `layer`, whose filter reaches `reach` px."""
        presence = {"PRESENCE": 1} if reach > 0.0 and "PAPER" not in self.defines else {}
        how["defines"] = {**self._defines(layer), **presence, **how.get("defines", {})}
        values = {"start": self.start, **(values or {}), **self._values(layer)} | ({"reach": reach} if presence else {})
        textures = {**self.textures, **(images or {})}
        if presence:
            textures["depths_nearest"] = self.nearest
            how["samplers"] = {**how.get("samplers", {}), "depths_nearest": self.recipe.gpu.linear}
        self.recipe.draw(shader, into, values=values, images=textures, **how)

    def _defines(self, layer: Layer) -> dict[str, object]:
        """Of the layers, only the farthest has to do with the background."""
        unused = () if layer.anchors[3] == -FAR else ("SKY", "EXHAUSTED")
        return {name: value for name, value in self.defines.items() if name not in unused}

    def final(self, focus: Layer, sides: dict[str, Image], *, fill: bool) -> Image:
        """Front buffer over the layer in focus over the back buffer, normalised."""
        defines = {f"HAS_{side.upper()}": 1 for side in sides}
        if fill:
            sides = sides | {"filled": self._filled(focus, sides.get("back"))}
            defines["FILL"] = 1
        picture = self.recipe.image("picture")
        guard = self.frame.guard
        self.draw(
            "final.frag", picture, focus, defines=defines, viewport=(guard, guard, *self.frame.inner_size), images=sides
        )
        return picture

    def _filled(self, focus: Layer, back: Image | None) -> Image:
        """Half the size: what is behind the front buffer, its holes filled from around them."""
        # Two surfaces of a pixel are enough to make up a third from.
        count = min(2, int(str(self.defines["PEELS"])))
        unused = {f"color{m}" for m in range(count, 8)} | {"depths_last"}
        textures = {name: image for name, image in self.textures.items() if name not in unused}
        textures |= {"back": back} if back else {}
        defines = self._defines(focus) | {"PEELS": count, **({"HAS_BACK": 1} if back else {})}
        if count < int(str(self.defines["PEELS"])):
            defines.pop("EXHAUSTED", None)
        with self.recipe.gpu.profile.section("layered/fill"):
            filled, _ = pull_push(
                self.recipe.gpu, "layered/fill", self.frame.size, "methods/layered/known.glsl", textures=textures,
                blocks=self.recipe.blocks, values={**self._values(focus), "window": tuple(self.window)},
                defines=defines,
            )  # fmt: skip
        return filled

    def _values(self, layer: Layer) -> dict[str, object]:
        return {"anchors": layer.anchors, "background": self.background}

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
        key = (self.frame.geometry_key, "layered content", self.defines["PEELS"], background_counts)
        if key not in self.frame.cache.values:
            depths, size = self.frame.depth_range(), self.frame.size
            extent = depths.nearest - depths.farthest_surface
            slices = SLICES / extent if extent > 0.0 else 0.0
            shape = (-(-size[0] // CELL), -(-size[1] // CELL))
            images = [
                self.recipe.image("content", shape, dtype="u4"), self.recipe.image("content extremes", shape),
                self.recipe.image("content sky", shape, 1),
            ]  # fmt: skip
            values = {"nearest": depths.nearest, "slices_per_depth": slices, "background_counts": background_counts}
            defines = {"CELL": CELL, "PEELS": self.defines["PEELS"]}
            self.recipe.draw("content.frag", images, defines=defines, values=values, images=self.depths)
            self.frame.cache.values[key] = Content(depths.nearest, slices, *(image.pixels()[::-1] for image in images))
        return self.frame.cache.values[key]  # type: ignore[return-value]
