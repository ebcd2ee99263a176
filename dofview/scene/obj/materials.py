"""MTL entries as metallic-roughness materials.

Colours are taken as linear numbers, as in glTF. `Pr` and `Pm` are used as they are; without `Pr`, roughness comes from
the exponent `Ns`: α = sqrt(2 / (Ns + 2)) (Walter et al. 2007), roughness = sqrt(α). Pictures that cannot be used are
left out with a warning, as in glTF. Faces show from both sides, as the format knows no back.
"""

from __future__ import annotations

import os
from dataclasses import dataclass, field
from pathlib import Path, PurePosixPath

import numpy as np

from dofview.errors import ModelError
from dofview.scene import pictures
from dofview.scene.files import Folder
from dofview.scene.model import AlphaMode, Material, Picture, Sampler, Texture, Wrap
from dofview.scene.notes import Notes, one_line
from dofview.scene.obj import library
from dofview.scene.obj.library import Entry, MapReference
from dofview.scene.repair import BRIGHTEST

MOST_LIBRARIES = 1000


@dataclass
class Materials:
    """Reads the libraries of one OBJ file and makes the materials its faces use."""

    folder: Folder
    notes: Notes
    made: list[Material] = field(default_factory=list)
    _entries: dict[str, tuple[Entry, Path]] = field(default_factory=dict)
    _slots: dict[str | None, int] = field(default_factory=dict)
    _pictures: dict[Path, Picture | None] = field(default_factory=dict)

    def read_libraries(self, statements: list[str]) -> None:
        """Read all `mtllib` statements; a missing library is a warning, as its faces can be shown without."""
        read: set[Path] = set()
        names = dict.fromkeys(name for statement in dict.fromkeys(statements) for name in self._names_in(statement))
        if len(names) > MOST_LIBRARIES:
            self.notes.say(f"{len(names)} material libraries named; only the first {MOST_LIBRARIES} read")
        for name in list(names)[:MOST_LIBRARIES]:
            try:
                path = self.folder.find(name)
                if path not in read:
                    read.add(path)
                    data = self.folder.read_relative(name)
                    for key, entry in library.parse(data, self.notes).items():
                        self._entries.setdefault(key, (entry, path.parent))
            except ModelError as error:
                self.notes.say(f"material library {error}")

    def _names_in(self, statement: str) -> list[str]:
        """The whole statement when there is such a file, else each part that ends in .mtl: names may hold spaces."""
        try:
            if os.path.isfile(self.folder.find(statement)):
                return [statement]
        except ModelError:
            pass
        names, words = [], []
        for word in statement.split(" "):
            words.append(word)
            if word.lower().endswith(".mtl"):
                names.append(" ".join(words))
                words = []
        return names or [statement]

    def slot(self, name: str | None) -> int:
        """The place in `made` of the material called `name`; None and unknown names are plain white."""
        if name not in self._slots:
            self._slots[name] = len(self.made)
            entry = self._entries.get(name) if name is not None else None
            if entry is None and name is not None:
                self.notes.say(f"material '{one_line(name, 80)}' is in no library that was read; shown plain")
            self.made.append(
                self._material(*entry) if entry else Material(_shown(name), metallic=0.0, double_sided=True)
            )
        return self._slots[name]

    def _material(self, entry: Entry, start: Path) -> Material:
        for keyword in dict.fromkeys(entry.left_out):
            self.notes.count(f"{keyword} texture", f"{keyword} textures", "not shown")
        numbers, maps = entry.numbers, entry.maps
        alpha = self._alpha(numbers, _shown(entry.name))
        base, cut_out = self._base_texture(maps, start)
        mode: AlphaMode = "MASK" if cut_out else "OPAQUE"
        if alpha < 1.0:
            mode = "BLEND"
            self.notes.count(
                "blended material", "blended materials", "blurred as what is behind where less than half opaque"
            )
        emissive = _color(numbers.get("Ke"), (0.0, 0.0, 0.0), BRIGHTEST)
        if "map_Ke" in maps and not any(emissive):
            emissive = (1.0, 1.0, 1.0)
        roughness, metallic = self._roughness_and_metallic(numbers, maps)
        return Material(
            name=_shown(entry.name),
            base_color=(*self._diffuse(entry), alpha),
            base_color_texture=base,
            metallic=metallic,
            roughness=roughness,
            metallic_roughness_texture=self._packed_texture(maps, start),
            normal_texture=self._texture(maps.get("norm"), start),
            emissive=emissive,
            emissive_texture=self._texture(maps.get("map_Ke"), start),
            unlit=numbers.get("illum") == (0.0,),
            double_sided=True,
            alpha_mode=mode,
        )

    def _diffuse(self, entry: Entry) -> tuple[float, float, float]:
        """`Kd`; black before a texture is a common exporter's slip and would hide it."""
        color = _color(entry.numbers.get("Kd"), (1.0, 1.0, 1.0), 1.0)
        if any(color) or "map_Kd" not in entry.maps:
            return color
        self.notes.say(f"material '{_shown(entry.name)}': Kd 0 0 0 would hide its map_Kd; taken as white")
        return 1.0, 1.0, 1.0

    def _alpha(self, numbers: dict[str, tuple[float, ...]], name: str) -> float:
        """Opacity from `d`, else from `Tr`, which some exporters write the other way round."""
        if "d" in numbers:
            return _within(numbers["d"][0])
        transparent = _within(numbers.get("Tr", (0.0,))[0])
        if transparent == 1.0:
            self.notes.say(f"material '{name}': Tr 1 would make it invisible; taken as opaque")
        return 1.0 - transparent if transparent < 1.0 else 1.0

    @staticmethod
    def _roughness_and_metallic(
        numbers: dict[str, tuple[float, ...]], maps: dict[str, MapReference]
    ) -> tuple[float, float]:
        exponent = max(numbers["Ns"][0], 0.0) if "Ns" in numbers else 0.0
        rough = numbers["Pr"][0] if "Pr" in numbers else 1.0 if "map_Pr" in maps else (2.0 / (exponent + 2.0)) ** 0.25
        return _within(rough), _within(numbers["Pm"][0] if "Pm" in numbers else 1.0 if "map_Pm" in maps else 0.0)

    def _base_texture(self, maps: dict[str, MapReference], start: Path) -> tuple[Texture | None, bool]:
        """The colour texture, with `map_d` put into its alpha; and whether it has such holes."""
        color, holes = self._texture(maps.get("map_Kd"), start), self._picture(maps.get("map_d"), start)
        if holes is None:
            return color, False
        reference = maps.get("map_Kd") or maps["map_d"]
        pixels = color.picture.pixels.copy() if color else np.full_like(holes.pixels, 255)
        if pixels.shape != holes.pixels.shape:
            self.notes.say(f"map_d '{holes.name}' has another size than map_Kd; not shown")
            return color, False
        # A picture that is its own mask carries it as alpha, a separate one as brightness.
        own = maps["map_d"].name == reference.name and (holes.pixels[..., 3] < 255).any()
        pixels[..., 3] = holes.pixels[..., 3] if own else holes.pixels[..., 0]
        return self._placed(Picture(holes.name, pixels), reference), True

    def _packed_texture(self, maps: dict[str, MapReference], start: Path) -> Texture | None:
        """`map_Pr` and `map_Pm` as one picture, roughness in green and metallic in blue."""
        rough, metal = (self._picture(maps.get(key), start) for key in ("map_Pr", "map_Pm"))
        present = rough or metal
        if present is None:
            return None
        pixels = np.full_like(present.pixels, 255)
        for channel, picture in ((1, rough), (2, metal)):
            if picture is None:
                continue
            if picture.pixels.shape != pixels.shape:
                self.notes.say(f"map_Pm '{picture.name}' has another size than map_Pr; not shown")
                continue
            pixels[..., channel] = picture.pixels[..., 0]
        return self._placed(Picture(present.name, pixels), maps["map_Pr" if rough else "map_Pm"])

    def _texture(self, reference: MapReference | None, start: Path) -> Texture | None:
        picture = self._picture(reference, start)
        return self._placed(picture, reference) if picture is not None and reference is not None else None

    @staticmethod
    def _placed(picture: Picture, reference: MapReference) -> Texture:
        """The MTL transform has v upwards, ours downwards: v' = 1 − (s (1 − v) + o)."""
        (su, sv), (ou, ov) = reference.scale, reference.offset
        moved = (su, sv, ou, ov) != (1.0, 1.0, 0.0, 0.0)
        wrap: Wrap = "clamp" if reference.clamp else "repeat"
        matrix = np.array([[su, 0.0, ou], [0.0, sv, 1.0 - sv - ov]]) if moved else None
        return Texture(picture, Sampler(wrap, wrap), transform=matrix)

    def _picture(self, reference: MapReference | None, start: Path) -> Picture | None:
        if reference is None:
            return None
        try:
            path = self.folder.find(reference.name, start)
            if not os.path.exists(path):  # many exporters write names relative to the .obj instead
                path = self.folder.find(reference.name)
            if path not in self._pictures:
                self._pictures[path] = None
                data = self.folder.read_relative(str(path.relative_to(self.folder.root)))
                self._pictures[path] = pictures.decode(data, _shown(reference.name), self.folder.account, path.suffix)
        except ModelError as error:
            self.notes.say(f"texture '{one_line(PurePosixPath(reference.name), 80)}': {error}; shown without it")
            return None
        return self._pictures[path]


def _shown(name: str | None) -> str:
    return one_line(name, 100) if name else "default"


def _within(value: float, high: float = 1.0) -> float:
    return min(max(value, 0.0), high)


def _color(
    values: tuple[float, ...] | None, default: tuple[float, float, float], high: float
) -> tuple[float, float, float]:
    """Three numbers, or one for all three (a statement may give only the first)."""
    if values is None:
        return default
    red, green, blue = values if len(values) == 3 else (values[0],) * 3
    return _within(red, high), _within(green, high), _within(blue, high)
