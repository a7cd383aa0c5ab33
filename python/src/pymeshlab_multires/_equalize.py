"""Gains for ranges of wavelengths that the caller chooses."""

import dataclasses
from collections.abc import Mapping

import numpy as np

from ._call import MeshSet
from ._filters import LIMITS, EnhanceReport, Pyramid, enhance


@dataclasses.dataclass(frozen=True, kw_only=True, eq=False)
class EqualizeReport:
    """What equalize() returns."""

    bands: dict[str, EnhanceReport]
    """The report of each range, in the order they were applied: from fine to coarse."""


def _limits(band: str) -> tuple[float, float]:
    """The two wavelengths of "0.5-1.0", "-0.5" (everything finer) or "4-" (everything coarser)."""
    fine, dash, coarse = band.replace("e-", "e~").partition("-")
    try:
        low = float(fine.replace("e~", "e-")) if fine.strip() else 0.0
        high = float(coarse.replace("e~", "e-")) if coarse.strip() else 1e30
    except ValueError:
        dash = ""
    # pymeshlab passes numbers on in single precision, where limits may be equal or infinite that are not so here.
    if not dash or not 0 <= low < high < float(np.finfo(np.float32).max) or np.float32(low) == np.float32(high):
        raise ValueError(f'"{band}" is no range of wavelengths; "0.5-1.0", "-0.5" and "4-" are')
    return low, high


def _check(what: str, parameter: str, value: float) -> None:
    least, most = LIMITS["enhance"][parameter]
    if not least <= value <= most:
        raise ValueError(f"{what} is {value}; it must be {least:g} to {most:g}")


def equalize(
    ms: MeshSet, gains: Mapping[str, float], *, softness: float = 0.0, pyramid: Pyramid | None = None
) -> EqualizeReport:
    """Multiplies the structure in ranges of wavelengths by gains: equalize(ms, {"0.5-1.0": 2.0, "4-": 0.8}).

    Each range is one pass of enhance(), fine ranges first; what no range holds stays. A pass builds its pyramid of what
    the one before left. Ranges, gains and softness are all checked before the first pass, so that a mistake in them
    changes nothing. Should a later pass still fail (no memory, or a gain that left nothing of the shape), the passes
    before it have been applied. For eight fixed bands in one pass: equalizer().

    Args:
        ms: the document; the current mesh is changed.
        gains: by range of wavelengths in mesh units, "0.5-1.0", "-0.5" (all that is finer) or "4-" (all that is
            coarser): the factor for the structure in it, in the range of enhance()'s gain: 1 leaves, 0 removes, 2
            doubles. Ranges must not overlap.
        softness: width of the edges of each range, in octaves; 0 is a sharp edge.
        pyramid: how each pass builds its pyramid. None: the filter's defaults.

    Raises:
        ValueError: a range that is none or overlaps another one, or a gain or softness that is out of range.
        pymeshlab.PyMeshLabException: the mesh will not do; it says why.
    """
    ranges = sorted((_limits(band), band) for band in gains)
    for ((_, end), band), ((start, _), other) in zip(ranges, ranges[1:]):
        if start < end:
            raise ValueError(f'"{band}" and "{other}" overlap')
    for band, gain in gains.items():
        _check(f'the gain of "{band}"', "gain", gain)
    _check("softness", "softness", softness)
    return EqualizeReport(
        bands={
            band: enhance(ms, gain=gains[band], finest=low, coarsest=high, softness=softness, pyramid=pyramid)
            for (low, high), band in ranges
        }
    )
