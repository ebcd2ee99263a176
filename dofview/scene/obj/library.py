"""MTL material libraries: every statement by name, and the options that stand before a texture's file name."""

from __future__ import annotations

from dataclasses import dataclass, field

from dofview.scene.notes import Notes, one_line
from dofview.scene.obj.statements import decode_name, normalise

MAPS = ("map_Kd", "map_Ke", "map_d", "map_Pr", "map_Pm", "norm")
MAPS_LEFT_OUT = (
    "map_Ka", "map_Ks", "map_Ns", "map_Bump", "map_bump", "bump", "disp", "decal", "refl", "map_Ps", "map_refl",
    "map_aat", "map_Disp", "map_disp",
)  # fmt: skip
LONGEST_MAP = 4096
_NUMBER_OPTIONS = {"-boost": 1, "-texres": 1, "-bm": 1, "-mm": 2, "-o": 3, "-s": 3, "-t": 3}
_WORD_OPTIONS = ("-blendu", "-blendv", "-cc", "-clamp", "-imfchan", "-type", "-colorspace")


@dataclass(frozen=True)
class MapReference:
    """A texture statement: the file name, the offset and scale of uv (v upwards), and whether it is clamped."""

    name: str
    offset: tuple[float, float] = (0.0, 0.0)
    scale: tuple[float, float] = (1.0, 1.0)
    clamp: bool = False


@dataclass
class Entry:
    """One `newmtl`: numbers by statement (`Kd` → three), textures by statement, and the statements left out."""

    name: str
    numbers: dict[str, tuple[float, ...]] = field(default_factory=dict)
    maps: dict[str, MapReference] = field(default_factory=dict)
    left_out: list[str] = field(default_factory=list)


def parse(data: bytes, notes: Notes) -> dict[str, Entry]:
    """Parse a library; a name that comes twice keeps the later entry."""
    entries: dict[str, Entry] = {}
    entry: Entry | None = None
    for line in normalise(data).split(b"\n"):
        keyword, _, rest = decode_name(line).strip().partition(" ")
        rest = rest.strip()
        if keyword == "newmtl":
            entry = entries[rest] = Entry(rest)
        elif not keyword or keyword.startswith("#"):
            continue
        elif entry is None:
            notes.count("line", "lines", "before the first newmtl ignored")
        elif keyword in MAPS and len(rest) > LONGEST_MAP:
            notes.say(f"material '{one_line(entry.name, 80)}': {keyword} of {len(rest)} characters not read")
        elif keyword in MAPS:
            entry.maps[keyword] = parse_map(rest)
        elif keyword in MAPS_LEFT_OUT:
            entry.left_out.append(keyword)
        else:
            numbers = _leading_numbers(rest.partition("#")[0].split(), 3)
            if numbers:
                entry.numbers[keyword] = tuple(numbers)
            elif keyword in ("Kd", "Ke"):
                notes.say(f"material '{one_line(entry.name, 80)}': {keyword} given as '{one_line(rest, 40)}' not read")
    return entries


def parse_map(text: str) -> MapReference:
    """Read `-options … file name`; the name may hold spaces, and options end at the first word that is none."""
    words = text.split()
    offset, scale, clamp = (0.0, 0.0), (1.0, 1.0), False
    while len(words) > 1 and words[0].startswith("-"):
        option = words[0].lower()
        if option in _NUMBER_OPTIONS:
            numbers = _leading_numbers(words[1:-1], _NUMBER_OPTIONS[option])
            words = words[1 + len(numbers) :]
            if option == "-o" and numbers:
                offset = numbers[0], (*numbers, 0.0)[1]
            elif option == "-s" and numbers:
                scale = numbers[0], (*numbers, 1.0)[1]
        elif option in _WORD_OPTIONS and len(words) > 2:
            clamp = clamp or (option == "-clamp" and words[1].lower() == "on")
            words = words[2:]
        else:
            break
    # The name as written, with whatever spaces it has; without options that is the whole text.
    first = words[0] if words else ""
    name = text if len(words) == len(text.split()) else text[_last_start(text, words) :]
    return MapReference(name.strip() if first else "", offset, scale, clamp)


def _last_start(text: str, words: list[str]) -> int:
    """Where the last `len(words)` words of `text` begin."""
    position = len(text)
    for word in reversed(words):
        position = text.rindex(word, 0, position)
    return position


def _leading_numbers(words: list[str], most: int) -> list[float]:
    numbers: list[float] = []
    for word in words[:most]:
        try:
            value = float(word)
        except ValueError:
            break
        if not -1e18 <= value <= 1e18:
            break
        numbers.append(value)
    return numbers
