"""Ways to break a model file: bytes flipped, cut and doubled, JSON values replaced, words of text replaced."""

from __future__ import annotations

import copy
import json
import random
from typing import Any

NUMBERS = [
    0,
    1,
    -1,
    2,
    3,
    255,
    256,
    65535,
    2**31 - 1,
    2**31,
    2**32,
    2**53,
    2**63,
    10**400,
    0.5,
    -0.0,
    1e-320,
    1e38,
    1e300,
]
VALUES: list[Any] = [
    *NUMBERS,
    None,
    True,
    False,
    "",
    "x",
    "\ud800",
    "../x",
    "data:,",
    [],
    {},
    [[]],
    [0],
    [-1],
    {"a": 1},
]
WORDS = (
    b"v vt vn f l usemtl mtllib s o g # / // 1/ /1 1/2/3/4 0 -1 -9 1 2 3 99 nan inf -inf 1e999 1e-999 1.#IND x \\ \\\n "
    b"\n \r \t \0 \xff \xef\xbb\xbf 9999999999999999999999 v\n f\n newmtl map_Kd Kd ../m.mtl C:\\m.mtl /dev/zero"
).split(b" ")


def mutated_bytes(data: bytes, rng: random.Random) -> bytes:
    """Flip, insert, delete, double or zero a few stretches."""
    result = bytearray(data)
    for _ in range(rng.choice((1, 1, 2, 5, 20))):
        at = rng.randrange(len(result) + 1)
        length = rng.choice((1, 1, 2, 4, 16, 200))
        kind = rng.randrange(6)
        if kind == 0 and at < len(result):
            result[at] ^= 1 << rng.randrange(8)
        elif kind == 1:
            result[at : at + length] = rng.randbytes(length)
        elif kind == 2:
            del result[at : at + length]
        elif kind == 3:
            result[at:at] = result[at : at + length] * rng.choice((1, 3))
        elif kind == 4:
            result[at : at + 4] = rng.choice((b"\xff\xff\xff\xff", b"\0\0\0\0", b"\0\0\0\x80", b"\xff\xff\xff\x7f"))
        else:
            del result[at if rng.random() < 0.3 else len(result) :]
    return bytes(result)


def mutated_json(document: Any, rng: random.Random) -> bytes:
    """Replace, remove or move a few values anywhere in a JSON document."""
    document = copy.deepcopy(document)
    for _ in range(rng.choice((1, 1, 1, 2, 4))):
        places = [(holder, key) for holder, key, _ in _values(document)]
        if not places:
            break
        holder, key = rng.choice(places)
        kind = rng.randrange(5)
        if kind == 0:
            del holder[key]
        elif kind == 1 and isinstance(holder[key], (int, float)) and abs(holder[key]) < 1e15:
            holder[key] += rng.choice((-1, 1, 1000, 0.5))
        elif kind == 2:
            other_holder, other_key = rng.choice(places)
            holder[key] = copy.deepcopy(other_holder[other_key])
        elif kind == 3 and isinstance(holder[key], list):
            holder[key] = holder[key] * rng.choice((2, 5))
        else:
            holder[key] = copy.deepcopy(rng.choice(VALUES))
    return json.dumps(document).replace("Infinity", "1e999").encode()


def mutated_text(data: bytes, rng: random.Random) -> bytes:
    """Replace, insert or remove words of a text."""
    words = data.replace(b"\n", b" \n ").split(b" ")
    for _ in range(rng.choice((1, 2, 4, 10))):
        at = rng.randrange(len(words) + 1)
        words[at : at + rng.randrange(3)] = [rng.choice(WORDS) for _ in range(rng.randrange(3))]
    return b" ".join(words)


def _values(value: Any) -> list[tuple[Any, Any, Any]]:
    found: list[tuple[Any, Any, Any]] = []
    pairs = value.items() if isinstance(value, dict) else enumerate(value) if isinstance(value, list) else ()
    for key, inner in pairs:
        found.append((value, key, inner))
        found.extend(_values(inner))
    return found
