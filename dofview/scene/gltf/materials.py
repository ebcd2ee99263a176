"""Materials, textures, samplers and images of a glTF file (§3.8, §3.9), each decoded when the first primitive uses it.

A picture that cannot be used never fails a model: it is left out with a warning and the plain factor is shown.
"""

from __future__ import annotations

import math
from pathlib import PurePosixPath
from typing import Literal

import numpy as np

from dofview.errors import ModelError
from dofview.scene import pictures
from dofview.scene.files import Folder
from dofview.scene.gltf.accessors import Accessors
from dofview.scene.gltf.container import Document
from dofview.scene.gltf.fields import Fields
from dofview.scene.model import MIN_FILTERS, AlphaMode, Material, Picture, Sampler, Texture, Wrap
from dofview.scene.notes import Notes, one_line
from dofview.scene.repair import BRIGHTEST

_WRAPS: dict[int, Wrap] = {33071: "clamp", 33648: "mirror", 10497: "repeat"}
_MAGNIFY: dict[int, Literal["NEAREST", "LINEAR"]] = {9728: "NEAREST", 9729: "LINEAR"}
_FILTERS = dict(zip((9728, 9729, 9984, 9985, 9986, 9987), MIN_FILTERS, strict=True))
_ALPHA_MODES: dict[str, AlphaMode] = {"OPAQUE": "OPAQUE", "MASK": "MASK", "BLEND": "BLEND"}
_NOTHING: dict = {}


class Materials:
    """The materials in use, in the order they came up; `made` becomes `Scene.materials`."""

    def __init__(self, document: Document, accessors: Accessors, folder: Folder, notes: Notes) -> None:
        self._document, self._accessors, self._folder, self._notes = document, accessors, folder, notes
        self.made: list[Material] = []
        self._slots: dict[int | None, int] = {}
        self._pictures: dict[int, Picture | None] = {}

    def slot(self, primitive: Fields) -> int:
        """The place in `made` of the material that a primitive asks for; without one, the default material's."""
        index = self._document.reference(primitive, "material", "materials")
        if index not in self._slots:
            self._slots[index] = len(self.made)
            self.made.append(Material() if index is None else self._material(self._document.entry("materials", index)))
        return self._slots[index]

    def _material(self, fields: Fields) -> Material:
        rough = fields.inside("pbrMetallicRoughness") or Fields(_NOTHING, f"{fields.where}.pbrMetallicRoughness")
        normal, occlusion = fields.inside("normalTexture"), fields.inside("occlusionTexture")
        return Material(
            name=fields.name("unnamed"),
            base_color=self._within(rough, "baseColorFactor", (1.0,) * 4),
            base_color_texture=self._texture(rough, "baseColorTexture"),
            metallic=self._within(rough, "metallicFactor", 1.0),
            roughness=self._within(rough, "roughnessFactor", 1.0),
            metallic_roughness_texture=self._texture(rough, "metallicRoughnessTexture"),
            normal_texture=self._texture(fields, "normalTexture"),
            normal_scale=self._within(normal, "scale", 1.0, -BRIGHTEST, BRIGHTEST) if normal else 1.0,
            occlusion_texture=self._texture(fields, "occlusionTexture"),
            occlusion_strength=self._within(occlusion, "strength", 1.0) if occlusion else 1.0,
            emissive=self._emissive(fields),
            emissive_texture=self._texture(fields, "emissiveTexture"),
            unlit=fields.extension("KHR_materials_unlit") is not None,
            double_sided=fields.flag("doubleSided"),
            alpha_mode=self._alpha_mode(fields),
            alpha_cutoff=self._within(fields, "alphaCutoff", 0.5, 0.0, BRIGHTEST),
        )

    def _alpha_mode(self, fields: Fields) -> AlphaMode:
        mode = _ALPHA_MODES.get(fields.text("alphaMode", "OPAQUE"))
        if mode is None:
            raise fields.fail("alphaMode", ", ".join(_ALPHA_MODES))
        if mode == "BLEND":
            self._notes.count(
                "blended material", "blended materials", "blurred as what is behind where less than half opaque"
            )
        return mode

    def _emissive(self, fields: Fields) -> tuple[float, float, float]:
        factor = self._within(fields, "emissiveFactor", (0.0,) * 3)
        extension = fields.extension("KHR_materials_emissive_strength")
        strength = self._within(extension, "emissiveStrength", 1.0, 0.0, BRIGHTEST) if extension else 1.0
        return tuple(value * strength for value in factor)

    def _within(self, fields: Fields, key: str, default, low: float = 0.0, high: float = 1.0):
        """A factor, or a tuple of them, clamped to [low, high] with a note."""
        single = not isinstance(default, tuple)
        values = (fields.number(key, default),) if single else fields.numbers(key, len(default), default)
        clamped = tuple(min(max(value, low), high) for value in values)
        if clamped != tuple(values):
            self._notes.say(f"{fields.where}.{key} clamped to [{low:g}, {high:g}]")
        return clamped[0] if single else clamped

    def _texture(self, owner: Fields, key: str) -> Texture | None:
        info = owner.inside(key)
        if info is None:
            return None
        index = self._document.reference(info, "index", "textures", required=True)
        assert index is not None
        fields = self._document.entry("textures", index)
        moved = info.extension("KHR_texture_transform")
        texcoord = info.integer("texCoord", 0)
        texcoord = moved.integer("texCoord", texcoord) if moved else texcoord
        if texcoord > 1:
            self._notes.say(f"{info.where} uses texture coordinate set {texcoord}; shown without it (sets 0 and 1 are)")
            return None
        picture = self._picture_of(fields)
        if picture is None:
            return None
        return Texture(picture, self._sampler(fields), texcoord, self._transform(moved) if moved else None)

    def _transform(self, fields: Fields) -> np.ndarray:
        """(2, 3): scale, then rotate, then move (KHR_texture_transform)."""
        bounds = (-1e6, 1e6)
        offset = self._within(fields, "offset", (0.0, 0.0), *bounds)
        scale = self._within(fields, "scale", (1.0, 1.0), *bounds)
        angle = math.remainder(fields.number("rotation", 0.0), math.tau)
        cosine, sine = math.cos(angle), math.sin(angle)
        return np.array(
            [[cosine * scale[0], sine * scale[1], offset[0]], [-sine * scale[0], cosine * scale[1], offset[1]]]
        )

    def _sampler(self, texture: Fields) -> Sampler:
        index = self._document.reference(texture, "sampler", "samplers")
        if index is None:
            return Sampler()
        fields = self._document.entry("samplers", index)
        wraps = [_WRAPS.get(fields.integer(key, 10497)) for key in ("wrapS", "wrapT")]
        magnify = _MAGNIFY.get(fields.integer("magFilter", 9729))
        minify = _FILTERS.get(fields.integer("minFilter", 9987))
        if wraps[0] is None or wraps[1] is None or magnify is None or minify is None:
            raise ModelError(f"{fields.where} holds an unknown wrap mode or filter")
        return Sampler(wraps[0], wraps[1], magnify, minify)

    def _picture_of(self, texture: Fields) -> Picture | None:
        webp = texture.extension("EXT_texture_webp")
        owner = webp if webp is not None and webp.data.get("source") is not None else texture
        index = self._document.reference(owner, "source", "images")
        if index is None:
            self._notes.say(f"{texture.where} has no picture that can be read; shown without it")
            return None
        if index not in self._pictures:
            self._pictures[index] = self._picture(self._document.entry("images", index))
        return self._pictures[index]

    def _picture(self, fields: Fields) -> Picture | None:
        try:
            uri = fields.text("uri", None)
            outside = uri is not None and not uri.startswith("data:")
            name = fields.name() or (one_line(uri, 100) if outside else fields.where)
            data = self._folder.read_uri(uri) if uri is not None else self._embedded(fields)
            self._folder.account.charge_geometry(len(data))
            return pictures.decode(data, name, self._folder.account, PurePosixPath(uri).suffix if outside else "")
        except ModelError as error:
            self._notes.say(f"{fields.where}: {error}; shown without this picture")
            return None

    def _embedded(self, fields: Fields) -> memoryview:
        index = self._document.reference(fields, "bufferView", "bufferViews", required=True)
        assert index is not None
        return self._accessors.view_bytes(index)
