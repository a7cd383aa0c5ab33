"""A page that refines a mesh in the browser while a slider moves through the bytes of its stream."""

import base64
import html
import json
import os
import pathlib
from typing import Any

import numpy as np

from ._stream import Stream, StreamMesh

TEMPLATE = pathlib.Path(__file__).with_name("stream_page.html")


def stream_page(source: bytes | str | os.PathLike[str], file: str | os.PathLike[str], *, steps: int = 24,
                title: str = "") -> None:  # fmt: skip
    """Writes one self-contained HTML page that shows a progressive file as it arrives.

    source: the file, or its bytes
    file: where the page goes
    steps: how many prefixes it shows, from the first mesh to all, each longer by the same factor; they are decoded here
    title: of the page; the file's name if empty
    """
    data = source if isinstance(source, bytes) else pathlib.Path(source).read_bytes()
    if not title and not isinstance(source, bytes):
        title = pathlib.Path(source).name
    shown = _prefixes(data, steps)
    final = shown[-1]["mesh"]
    low, size = final.vertices.min(axis=0), max(float(np.ptp(final.vertices, axis=0).max()), 1e-30)
    middle = (low + final.vertices.max(axis=0)) / 2
    levels = [_level(step, middle, size) for step in shown]
    text = TEMPLATE.read_text(encoding="utf-8").replace("TITLE", html.escape(title or "A mesh that streams"))
    pathlib.Path(file).write_text(text.replace('"LEVELS"', json.dumps(levels)), encoding="utf-8")


def _prefixes(data: bytes, steps: int) -> list[dict[str, Any]]:
    """The prefixes to show: bytes, mesh and error, each with more vertices than the one before."""
    stream, at, first = Stream(), 0, 0
    shown: list[dict[str, Any]] = []
    while not stream.finished and at < len(data):
        ratio = (len(data) / first) ** (1 / max(steps - 1, 1)) if first else 1
        until = min(len(data), max(at + 64, int(first * ratio ** len(shown)) if first else at + 64))
        stream.feed(data[at:until])
        at = until
        if not stream.started or (shown and stream.vertices == len(shown[-1]["mesh"].vertices) and not stream.finished):
            continue
        first = first or at
        shown.append({"bytes": at, "mesh": stream.mesh(), "error": stream.error})
    if not shown:
        stream.mesh()  # says why there is none
    return shown


def _level(step: dict[str, Any], middle: Any, size: float) -> dict[str, Any]:
    mesh: StreamMesh = step["mesh"]
    cells = np.clip(np.round((mesh.vertices - middle) / size * 60000), -32767, 32767).astype("<i2")
    indices = mesh.faces.astype("<u4")
    return {"bytes": step["bytes"], "vertices": len(mesh.vertices), "faces": len(mesh.faces),
            "error": step["error"] / size, "cells": _text(cells), "indices": _text(indices)}  # fmt: skip


def _text(array: Any) -> str:
    return base64.b64encode(array.tobytes()).decode("ascii")
