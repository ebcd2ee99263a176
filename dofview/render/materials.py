"""Materials on the GPU: textures, one uniform block each, and the shader features each needs."""

from __future__ import annotations

from dataclasses import dataclass

import moderngl
import numpy as np
from pydantic import BaseModel, ConfigDict

from dofview.gl.context import Gpu
from dofview.gl.passes import draw
from dofview.render.blended import is_translucent
from dofview.scene.model import Material, Texture

_FILTER = {
    "NEAREST": 0x2600, "LINEAR": 0x2601, "NEAREST_MIPMAP_NEAREST": 0x2700, "LINEAR_MIPMAP_NEAREST": 0x2701,
    "NEAREST_MIPMAP_LINEAR": 0x2702, "LINEAR_MIPMAP_LINEAR": 0x2703,
}  # fmt: skip
_SLOTS = ("base_color", "metallic_roughness", "normal", "occlusion", "emissive")
_COLOR_SLOTS = ("base_color", "emissive")

Vec4 = tuple[float, float, float, float]


class MaterialBlock(BaseModel):
    """What a shader reads of a material. Each `…_uv` pair is the rows of the 2×3 uv transform; w of the first row is
    the texture-coordinate set."""

    model_config = ConfigDict(frozen=True)

    base_color: Vec4
    emissive: Vec4
    metallic: float
    roughness: float
    normal_scale: float
    occlusion_strength: float
    alpha_cutoff: float
    base_color_uv0: Vec4 = (1.0, 0.0, 0.0, 0.0)
    base_color_uv1: Vec4 = (0.0, 1.0, 0.0, 0.0)
    metallic_roughness_uv0: Vec4 = (1.0, 0.0, 0.0, 0.0)
    metallic_roughness_uv1: Vec4 = (0.0, 1.0, 0.0, 0.0)
    normal_uv0: Vec4 = (1.0, 0.0, 0.0, 0.0)
    normal_uv1: Vec4 = (0.0, 1.0, 0.0, 0.0)
    occlusion_uv0: Vec4 = (1.0, 0.0, 0.0, 0.0)
    occlusion_uv1: Vec4 = (0.0, 1.0, 0.0, 0.0)
    emissive_uv0: Vec4 = (1.0, 0.0, 0.0, 0.0)
    emissive_uv1: Vec4 = (0.0, 1.0, 0.0, 0.0)


@dataclass(frozen=True, eq=False)
class GpuMaterial:
    """One material ready to draw: its block, its textures by sampler name, the defines its shader needs."""

    block: MaterialBlock
    textures: dict[str, tuple[moderngl.Texture, moderngl.Sampler]]
    features: dict[str, bool]
    double_sided: bool
    translucent: bool


class MaterialSet:
    """All materials of a scene; pictures and samplers shared between them exist once."""

    def __init__(self, gpu: Gpu, materials: tuple[Material, ...], translucent_colors: frozenset[int] = frozenset()):
        """`translucent_colors` are the numbers of those materials whose vertex colours let light through."""
        self._gpu = gpu
        self._pictures: dict[tuple, moderngl.Texture] = {}
        self._samplers: dict[object, moderngl.Sampler] = {}
        self.items = tuple(self._upload(m, number in translucent_colors) for number, m in enumerate(materials))

    def release(self) -> None:
        for texture in self._pictures.values():
            texture.release()
        for sampler in self._samplers.values():
            sampler.release()
        self._pictures.clear()
        self._samplers.clear()

    def _upload(self, material: Material, translucent_colors: bool) -> GpuMaterial:
        textures: dict[str, tuple[moderngl.Texture, moderngl.Sampler]] = {}
        features: dict[str, bool] = {}
        transforms: dict[str, Vec4] = {}
        for slot in _SLOTS:
            texture: Texture | None = getattr(material, f"{slot}_texture")
            if texture is None or (material.unlit and slot != "base_color"):
                continue
            color = slot in _COLOR_SLOTS
            textures[f"{slot}_map"] = self._picture(texture, color), self._sampler(texture)
            features[f"{slot.upper()}_MAP"] = True
            matrix = np.array(np.eye(2, 3) if texture.transform is None else texture.transform, np.float64)
            matrix *= [[0.5 if wrap == "mirror" else 1.0] for wrap in _wraps(texture)]
            transforms[f"{slot}_uv0"] = (*matrix[0].tolist(), float(texture.texcoord))
            transforms[f"{slot}_uv1"] = (*matrix[1].tolist(), 0.0)
        if material.unlit:
            features["UNLIT"] = True
        if material.alpha_mode != "OPAQUE":
            features["ALPHA_TEST"] = True
        block = MaterialBlock(
            base_color=material.base_color, emissive=(*material.emissive, 0.0), metallic=material.metallic,
            roughness=material.roughness, normal_scale=material.normal_scale,
            occlusion_strength=material.occlusion_strength,
            alpha_cutoff=material.alpha_cutoff if material.alpha_mode == "MASK" else 0.5, **transforms,
        )  # fmt: skip
        return GpuMaterial(
            block, textures, features, material.double_sided, is_translucent(material, translucent_colors)
        )

    def _picture(self, texture: Texture, color: bool) -> moderngl.Texture:
        mirrored = tuple(wrap == "mirror" for wrap in _wraps(texture))
        key = (id(texture.picture), color, mirrored)
        if key not in self._pictures:
            pixels = texture.picture.pixels
            # moderngl has no mirrored repeat: the picture beside its mirror image, repeated, is the same.
            for axis in (1, 0):
                if mirrored[1 - axis]:
                    pixels = np.concatenate([pixels, np.flip(pixels, axis)], axis)
            self._pictures[key] = _upload_picture(self._gpu, np.ascontiguousarray(pixels), color)
        return self._pictures[key]

    def _sampler(self, texture: Texture) -> moderngl.Sampler:
        if texture.sampler not in self._samplers:
            from_file = texture.sampler
            sampler = self._gpu.ctx.sampler()
            sampler.filter = (_FILTER[from_file.minify], _FILTER[from_file.magnify])
            sampler.repeat_x = from_file.wrap_s != "clamp"
            sampler.repeat_y = from_file.wrap_t != "clamp"
            self._samplers[from_file] = sampler
        return self._samplers[texture.sampler]


def _wraps(texture: Texture) -> tuple[str, str]:
    return texture.sampler.wrap_s, texture.sampler.wrap_t


def _upload_picture(gpu: Gpu, pixels: np.ndarray, color: bool) -> moderngl.Texture:
    """Make a mipmapped texture of (h, w, 4) uint8 pixels; colours are linear when sampled."""
    height, width = pixels.shape[:2]
    if max(width, height) > gpu.max_size:
        step = -(-max(width, height) // gpu.max_size)
        pixels = np.ascontiguousarray(pixels[::step, ::step])
        height, width = pixels.shape[:2]
    if color and (height * width <= HALF_FLOAT_PIXELS or not _decodes_srgb_exactly(gpu)):
        linear = np.empty(pixels.shape, np.float16)
        linear[..., :3] = SRGB_TO_LINEAR[pixels[..., :3]]
        linear[..., 3] = pixels[..., 3] / 255.0
        texture = gpu.ctx.texture((width, height), 4, linear.tobytes(), dtype="f2", alignment=1)
    elif color:
        texture = gpu.ctx.texture((width, height), 4, pixels.tobytes(), internal_format=GL_SRGB8_ALPHA8)
    else:
        texture = gpu.ctx.texture((width, height), 4, pixels.tobytes())
    texture.build_mipmaps()
    return texture


def _decodes_srgb_exactly(gpu: Gpu) -> bool:
    """Whether sampling an sRGB texture decodes to within fp16's precision; llvmpipe's polynomial is 0.4 % off."""
    if "decodes_srgb_exactly" not in gpu.facts:
        levels = np.repeat(np.arange(256, dtype=np.uint8), 4)
        texture = gpu.ctx.texture((256, 1), 4, levels.tobytes(), internal_format=GL_SRGB8_ALPHA8)
        texture.filter = (moderngl.NEAREST, moderngl.NEAREST)
        decoded = gpu.targets.image("probe/srgb", (256, 1))
        draw(gpu, "pass/copy.frag", decoded, textures={"source": texture})
        error = np.abs(decoded.pixels()[0, :, 0] - SRGB_TO_LINEAR) / np.maximum(SRGB_TO_LINEAR, 1e-4)
        gpu.facts["decodes_srgb_exactly"] = bool(error.max() < 5e-4)
        texture.release()
    return bool(gpu.facts["decodes_srgb_exactly"])


GL_SRGB8_ALPHA8 = 0x8C43
HALF_FLOAT_PIXELS = 2048 * 2048
"""Pictures up to this size are half floats everywhere: eight bits are rounded again in every mip level, by each driver
in its own way (mean FLIP between two of them 0.013, with half floats 0.008), but take half the memory."""
_LEVELS = np.arange(256) / 255.0
SRGB_TO_LINEAR = np.where(_LEVELS <= 0.04045, _LEVELS / 12.92, ((_LEVELS + 0.055) / 1.055) ** 2.4)
