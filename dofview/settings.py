"""Everything a picture depends on, as one frozen value: camera, lens, method, its parameters, size.

"Changed" is `!=`; that is all the progressive reference and the frame cache need. A view file is a part of this in
JSON.
"""

from __future__ import annotations

import json
import stat
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, TypeVar

from pydantic import BaseModel, ConfigDict, Field, ValidationError, create_model

from dofview import fields
from dofview.errors import SettingsError
from dofview.lens import Lens
from dofview.methods import METHODS, method
from dofview.methods.method import Params
from dofview.render.display import Display
from dofview.render.environment import Lighting
from dofview.scene.camera import Camera

LARGEST_SIDE = 16384
LARGEST_VIEW = 16 << 20
M = TypeVar("M", bound=BaseModel)
Side = Annotated[int, Field(ge=1, le=LARGEST_SIDE)]
Linear = Annotated[float, Field(ge=0.0, le=1e4, allow_inf_nan=False)]

if TYPE_CHECKING:
    MethodParams = Any  # made from a list, so its fields are not known before it runs
else:
    MethodParams = create_model(
        "MethodParams", __config__=ConfigDict(frozen=True, extra="forbid"),
        __doc__="The parameters of every method, by name.",
        **{name: (method(name).Params, method(name).Params()) for name in METHODS},
    )  # fmt: skip


class ImageSettings(BaseModel):
    """The picture's size and how it is sampled."""

    model_config = ConfigDict(frozen=True)

    size: tuple[Side, Side] = Field(default=(1024, 768), description="Width and height, pixels.")
    scale: float = Field(
        default=1.0, ge=0.5, le=2.0, description="Rendered at this multiple of the size, then averaged in linear light."
    )
    guard_px: int | None = Field(
        default=None, ge=0, le=512, description="Band around the picture that may blur in; as needed when not given."
    )


class Settings(BaseModel):
    """One picture."""

    model_config = ConfigDict(frozen=True)

    camera: Camera = Camera()
    lens: Lens = Lens()
    method: str = "accumulation"
    params: MethodParams = MethodParams()
    image: ImageSettings = ImageSettings()
    display: Display = Display()
    light: Lighting = Lighting()
    background_linear: tuple[Linear, Linear, Linear] = Field(
        default=(0.05, 0.055, 0.065), description="Colour where nothing is, linear RGB."
    )

    @property
    def method_params(self) -> Params:
        """The parameters of the chosen method."""
        return getattr(self.params, self.method)

    def with_(self, **changes: object) -> Settings:
        """A copy with `changes` checked and applied; nested models are replaced whole."""
        return checked(Settings, {**{name: getattr(self, name) for name in type(self).model_fields}, **changes})

    def with_params(self, **changes: object) -> Settings:
        """A copy with parameters of the chosen method changed."""
        params = checked(type(self.method_params), {**self.method_params.model_dump(), **changes}, self.method)
        return self.with_(params=self.params.model_copy(update={self.method: params}))


def checked(model: type[M], values: dict, where: str = "") -> M:
    """Build `model` from `values`, or say in one line which key, which value and what would be accepted."""
    try:
        return model.model_validate(values)
    except ValidationError as error:
        raise SettingsError(explain(error, model, where)) from error


def explain(error: ValidationError, model: type[BaseModel], where: str = "") -> str:
    """The first complaint of a validation error in one line: where, key, value, what is accepted."""
    first = error.errors()[0]
    key = ".".join(str(part) for part in first["loc"])
    prefix = f"{where}: " if where else ""
    if first["type"] == "extra_forbidden":
        return f"{prefix}no parameter {key}; accepted: {', '.join(model.model_fields) or 'none'}"
    message = first["msg"].removeprefix("Value error, ")
    if not key:
        return f"{prefix}{message}"
    field = model.model_fields.get(key) if first["type"] != "value_error" else None
    wanted = fields.accepted(field) if field else ""
    return f"{prefix}{key} is {_shown(first.get('input'))}; " + (f"accepted: {wanted}" if wanted else message)


def _shown(value: object, length: int = 60) -> str:
    """A value as it was given, cut when it is long; a whole number of a million digits has no repr."""
    try:
        text = repr(value)
    except ValueError:
        text = "a number with too many digits"
    return text if len(text) <= length else text[: length - 1] + "…"


_PARTS = (("camera", Camera), ("lens", Lens), ("image", ImageSettings), ("light", Lighting))


def read_view(path: Path, base: Settings) -> Settings:
    """Return `base` with what the JSON view file `path` says of camera, lens, light, image size and background.

    Unknown keys are ignored; a wrong value is a SettingsError naming file and key.
    """
    try:
        found = path.stat()
        if not stat.S_ISREG(found.st_mode) or found.st_size > LARGEST_VIEW:
            raise SettingsError(f"{path}: not a view file; accepted: a JSON file of at most {LARGEST_VIEW >> 20} MiB")
        view = json.loads(path.read_text(encoding="utf-8-sig"))
    except OSError as error:
        raise SettingsError(f"{path}: cannot read view file: {(error.strerror or str(error)).lower()}") from error
    except (ValueError, RecursionError) as error:
        raise SettingsError(f"{path}: not a JSON view file: {error}") from error
    return apply_view(base, view, str(path), path.parent)


def apply_view(base: Settings, view: object, where: str, folder: Path | None = None) -> Settings:
    """Return `base` with what `view`, the content of a view file, says; pictures are looked for in `folder` first."""
    if not isinstance(view, dict):
        raise SettingsError(
            f"{where}: a view file holds one JSON object with camera, lens, light, image, background_linear"
        )
    changes: dict[str, object] = {}
    for key, model in _PARTS:
        if view.get(key) is None:
            continue
        if not isinstance(view[key], dict):
            raise SettingsError(f"{where}: {key} is {_shown(view[key])}; accepted: an object")
        names = {"size"} if key == "image" else model.model_fields.keys()
        given = {k: v for k, v in view[key].items() if k in names}
        for picture in ("image", "environment"):
            if isinstance(given.get(picture), str):
                given[picture] = _beside(folder, given[picture])
        changes[key] = checked(model, {**getattr(base, key).model_dump(), **given}, f"{where}: {key}")
    if view.get("background_linear") is not None:
        changes["background_linear"] = view["background_linear"]
    try:
        return base.with_(**changes)
    except SettingsError as error:
        raise SettingsError(f"{where}: {error}") from error


def view_of(settings: Settings) -> dict[str, Any]:
    """The content of a view file from which `apply_view` makes this view again."""
    view = {key: getattr(settings, key).model_dump(mode="json") for key, _ in _PARTS}
    view["image"] = {"size": list(settings.image.size)}
    view["background_linear"] = list(settings.background_linear)
    return view


def _beside(folder: Path | None, name: str) -> str:
    """A picture named in a view file is looked for beside it first."""
    try:
        found = folder is not None and (folder / name).is_file()
    except (OSError, ValueError):
        found = False
    return str(folder / name) if folder and found else name
