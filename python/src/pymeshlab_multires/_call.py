"""Loading the plugins, and calling a filter."""

import dataclasses
import pathlib
from typing import Any, Protocol, TypeAlias, TypeVar

import numpy as np
import numpy.typing as npt

Array: TypeAlias = npt.NDArray[np.float64]
Report = TypeVar("Report")


class MeshSet(Protocol):
    """What is used of pymeshlab.MeshSet, which has no types of its own."""

    def apply_filter(self, filter_name: str, /, **parameters: Any) -> Any: ...


def load_plugins() -> None:
    """Loads the package's plugins into pymeshlab; one that was loaded by hand before stays.

    Raises ImportError if the package holds none.
    """
    import pymeshlab  # type: ignore[import-untyped, unused-ignore]

    plugins = sorted((pathlib.Path(__file__).parent / "plugins").glob("libfilter_multires_*.so"))
    if not plugins:
        raise ImportError(f"{__package__} was installed without its plugins")
    for plugin in plugins:
        try:
            pymeshlab.load_plugin(str(plugin))
        except pymeshlab.PyMeshLabException as error:
            if "already loaded" not in str(error):
                raise


def apply(kind: type[Report], ms: MeshSet, name: str, parameters: dict[str, Any]) -> Report:
    """Applies the filter with the parameters that are not None; its report as the dataclass `kind`.

    A field that is a dictionary gets what has its name behind that of an attribute: color_noise is noise["color"].
    """
    returned = dict(ms.apply_filter(name, **{key: value for key, value in parameters.items() if value is not None}))
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
