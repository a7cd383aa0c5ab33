"""Loading the plugins, and calling a filter."""

import contextlib
import dataclasses
import functools
import importlib.metadata
import pathlib
import warnings
from collections.abc import Callable, Iterator
from typing import Any, ParamSpec, Protocol, TypeAlias, TypeVar

import numpy as np
import numpy.typing as npt

Array: TypeAlias = npt.NDArray[np.float64]
Vector: TypeAlias = tuple[float, float, float]
Parameters = ParamSpec("Parameters")
Report = TypeVar("Report")


class MeshSet(Protocol):
    """What is used of pymeshlab.MeshSet, which has no types of its own."""

    def apply_filter(self, filter_name: str, /, **parameters: Any) -> Any: ...


BUILT_FOR = "2025.7"  # a plugin works in the pymeshlab it was built for and in no other


def check_pymeshlab() -> None:
    """Raises ImportError if the pymeshlab that is installed is another one. What does not tell its version may pass."""
    with contextlib.suppress(importlib.metadata.PackageNotFoundError):
        found = importlib.metadata.version("pymeshlab")
        if f"{found}.".startswith(f"{BUILT_FOR}."):
            return
        raise ImportError(f"{__package__} was built for pymeshlab {BUILT_FOR}, and {found} is installed: "
                          f"pip install 'pymeshlab=={BUILT_FOR}.*'")  # fmt: skip


def load_plugins() -> None:
    """Loads the package's plugins into pymeshlab; one that was loaded by hand before stays.

    Raises ImportError if the package holds none, or if they were built for another pymeshlab.
    """
    check_pymeshlab()
    import pymeshlab  # type: ignore[import-untyped, unused-ignore]

    found = (pathlib.Path(__file__).parent / "plugins").glob("*_multires*")
    plugins = sorted(file for file in found if file.suffix in (".so", ".dylib", ".dll"))
    if not plugins:
        raise ImportError(f"{__package__} was installed without its plugins")
    for plugin in plugins:
        try:
            pymeshlab.load_plugin(str(plugin))
        except pymeshlab.PyMeshLabException as error:
            if "already loaded" not in str(error):
                raise ImportError(f"{plugin}: {error}") from error


@contextlib.contextmanager
def forgetting_failures() -> Iterator[None]:
    """Around calls of pymeshlab: lets an exception through, and forgets the document it came from."""
    try:
        yield
    except BaseException:
        forget_failed_document()
        raise


def forget_failed_document() -> None:
    """Makes pymeshlab forget the document on which a filter failed.

    pymeshlab 2025.7 keeps a pointer to the log of the document a filter runs on, and clears it only if the filter
    succeeds. The progress of every later load is written to that log, also when the document is gone, which ends the
    process. A filter that succeeds on any other document clears the pointer; the user's document stays as it is.
    """
    import pymeshlab

    pymeshlab.MeshSet().create_cube()


def also_flat(options: type[Any]) -> Callable[[Callable[Parameters, Report]], Callable[Parameters, Report]]:
    """Lets a function that takes `pyramid`, a dataclass `options`, take its fields as keywords as well, with a
    DeprecationWarning. Type checkers see the function as it is written."""
    names = {field.name for field in dataclasses.fields(options)}

    def decorate(function: Callable[Parameters, Report]) -> Callable[Parameters, Report]:
        @functools.wraps(function)
        def called(*args: Parameters.args, **keywords: Parameters.kwargs) -> Report:
            flat = {name: keywords.pop(name) for name in names & keywords.keys()}
            if flat:
                written = ", ".join(f"{name}={value!r}" for name, value in flat.items())
                warnings.warn(f"write {function.__name__}(..., pyramid={options.__name__}({written}))",
                              DeprecationWarning, stacklevel=2)  # fmt: skip
                keywords["pyramid"] = dataclasses.replace(keywords.get("pyramid") or options(), **flat)  # type: ignore[type-var]
            return function(*args, **keywords)

        return called

    return decorate


def apply(kind: type[Report], name: str, ms: MeshSet, pyramid: Any = None, **parameters: Any) -> Report:
    """Applies the filter with the parameters that are not None; its report as the dataclass `kind`.

    A field that is a dictionary gets what has its name behind that of an attribute: color_noise is noise["color"].
    """
    parameters |= dataclasses.asdict(pyramid) if pyramid is not None else {}
    given = {key: np.array(value) if isinstance(value, tuple) else value
             for key, value in parameters.items() if value is not None}  # fmt: skip
    with forgetting_failures():
        returned = dict(ms.apply_filter(name, **given))
    fields = {field.name: field for field in dataclasses.fields(kind)}  # type: ignore[arg-type]
    by_attribute = [n for n, field in fields.items() if field.default_factory is not dataclasses.MISSING]
    values: dict[str, Any] = {n: {} for n in by_attribute}
    for key, value in returned.items():
        value = np.atleast_1d(value) if isinstance(value, np.ndarray) else value
        # The longest name that fits: color_noise_per_level is not the noise of "color_noise_per".
        owner = max((n for n in by_attribute if key.endswith("_" + n)), key=len, default=None)
        if key in fields:
            values[key] = value
        elif owner is not None:
            values[owner][key[: -len(owner) - 1]] = value
    return kind(**values)
