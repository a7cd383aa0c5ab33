"""Filters with their values, or an .mlx, as steps that can be sent to another process as JSON."""

import ast
import dataclasses
import difflib
import math
import pathlib
import types
import typing
import xml.etree.ElementTree as ET
from collections.abc import Iterable, Sequence
from typing import Any, TypeAlias

from .. import _filters

# {"percent": 3.0} and {"absolute": 0.2} are pymeshlab's PercentageValue and PureValue; a list is a point.
Value: TypeAlias = bool | int | float | str | list[float] | dict[str, float]

FUNCTION = {filter_name: function for function, (filter_name, _) in _filters.FILTERS.items()}
IN_MENU = {title: filter_name for filter_name, title in _filters.FILTERS.values()}


@dataclasses.dataclass
class Step:
    """One filter."""

    label: str
    """Where its report stands in the table: the function's name, or the filter's."""
    filter: str = ""
    """pymeshlab's name of the filter."""
    values: dict[str, Value] = dataclasses.field(default_factory=dict)
    script: str = ""
    """Instead: an .mlx of one filter that is not ours. pymeshlab returns no report of scripts."""


def numbered(steps: Sequence[Step]) -> list[Step]:
    """The steps, with a number behind labels that stand more than once: denoise, denoise_2."""
    seen: dict[str, int] = {}
    for step in steps:
        seen[step.label] = seen.get(step.label, 0) + 1
        if seen[step.label] > 1:
            step.label += f"_{seen[step.label]}"
    return list(steps)


# ---- the command line ------------------------------------------------------------------------------------------------


def find_filter(word: str) -> Step | None:
    """The filter of that name: a function of the package, or any filter of pymeshlab; None if there is none."""
    import pymeshlab  # type: ignore[import-untyped, unused-ignore]

    if word in _filters.FILTERS:
        return Step(word, _filters.FILTERS[word][0])
    if word in FUNCTION:
        return Step(FUNCTION[word], word)
    return Step(word, word) if word in pymeshlab.filter_list() else None


def similar(word: str, names: Iterable[str]) -> str:
    """", did you mean ...?" or nothing."""
    near = difflib.get_close_matches(word, list(names), 1)
    return f", did you mean {near[0]}?" if near else ""


def _hints(function: str) -> dict[str, Any]:
    """Types of the parameters of the package's function, those of the pyramid among them."""
    hints = typing.get_type_hints(getattr(_filters, function))
    if "pyramid" in hints:
        hints |= typing.get_type_hints(_filters.Pyramid)
    return {name: hint for name, hint in hints.items() if name not in ("ms", "pyramid", "return")}


def _kind(hint: Any) -> Any:
    """The hint without "or None"."""
    if typing.get_origin(hint) in (typing.Union, types.UnionType):
        return next(kind for kind in typing.get_args(hint) if kind is not types.NoneType)
    return hint


def _truth(text: str) -> bool:
    if text.lower() not in ("true", "false", "yes", "no", "1", "0"):
        raise ValueError("must be true or false")
    return text.lower() in ("true", "yes", "1")


def _point(text: str) -> list[float]:
    numbers = [float(word) for word in text.split(",")]
    if len(numbers) != 3:
        raise ValueError("must be three numbers: x,y,z")
    return numbers


def _by_hint(text: str, hint: Any) -> Value:
    kind = _kind(hint)
    if typing.get_origin(kind) is typing.Literal:
        if text not in (names := typing.get_args(kind)):
            raise ValueError(f"must be one of {', '.join(names)}{similar(text, names)}")
        return text
    if kind is bool:
        return _truth(text)
    if kind in (int, float):
        return typing.cast(Value, kind(text))
    return _point(text) if typing.get_origin(kind) is tuple else text


def _by_looks(text: str) -> Value:
    """For filters of pymeshlab, which do not tell the types of their parameters."""
    if text.lower() in ("true", "false"):
        return _truth(text)
    if text.endswith("%"):
        return {"percent": float(text[:-1])}
    if text.startswith("abs:"):
        return {"absolute": float(text[4:])}
    if text.count(",") == 2:
        return _point(text)
    try:
        value = ast.literal_eval(text)
    except (ValueError, SyntaxError):
        return text
    return value if isinstance(value, (int, float)) else text


def set_value(step: Step, word: str) -> None:
    """Sets what "name=value" says.

    Raises ValueError, which names filter and parameter.
    """
    name, _, text = word.partition("=")
    if step.filter not in FUNCTION:
        step.values[name] = _by_looks(text)
        return
    hints = _hints(FUNCTION[step.filter])
    if name not in hints:
        raise ValueError(f"{step.label} has no parameter {name}{similar(name, hints)}")
    try:
        value = _by_hint(text, hints[name])
    except ValueError as error:
        raise ValueError(f"{step.label}: {name}={text}: {error}") from None
    limits = _filters.LIMITS.get("Pyramid", {}) | _filters.LIMITS.get(FUNCTION[step.filter], {})
    least, most = limits.get(name, (-math.inf, math.inf))
    if isinstance(value, (int, float)) and not least <= value <= most:  # NaN, too
        raise ValueError(f"{step.label}: {name}={text}: must be {least:g} to {most:g}")
    step.values[name] = value


# ---- .mlx ------------------------------------------------------------------------------------------------------------


def _script_value(param: ET.Element) -> Value:
    kind, text = param.get("type", ""), param.get("value", "")
    if kind == "RichPoint3f":
        return [float(param.get(axis, "0")) for axis in "xyz"]
    if kind == "RichBool":
        return text == "true"
    if kind in ("RichInt", "RichEnum", "RichMesh"):
        return int(text)
    return float(text) if kind in ("RichFloat", "RichDynamicFloat") else text


def read_script(path: pathlib.Path) -> list[Step]:
    """The filters of an .mlx. Ours are called by name, and so have reports; others run as they are written.

    Raises ValueError if the file is not a script of filters.
    """
    try:
        root = ET.parse(path).getroot()
    except ET.ParseError as error:
        raise ValueError(f"{path}: {error}") from None
    if root.tag != "FilterScript" or len(root) == 0:
        raise ValueError(f"{path} is not a script of filters")
    steps = []
    for element in root:
        title = element.get("name", "")
        if title in IN_MENU:
            name = IN_MENU[title]
            values = {param.get("name", ""): _script_value(param) for param in element}
            steps.append(Step(FUNCTION[name], name, values))
        else:
            alone = ET.Element("FilterScript")
            alone.append(element)
            steps.append(Step(title, script="<!DOCTYPE FilterScript>\n" + ET.tostring(alone, encoding="unicode")))
    return steps
