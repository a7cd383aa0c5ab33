"""Gains for ranges of wavelengths that the caller chooses."""

import dataclasses
import math
from collections.abc import Mapping

from ._call import MeshSet
from ._filters import EnhanceReport, enhance

MOST_GAIN = 8.0
"""The largest gain that the filter takes."""


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
    if not dash or not 0 <= low < high < math.inf:
        raise ValueError(f'"{band}" is no range of wavelengths; "0.5-1.0", "-0.5" and "4-" are')
    return low, high


def equalize(ms: MeshSet, gains: Mapping[str, float], *, softness: float = 0.0) -> EqualizeReport:
    """Multiplies the structure in ranges of wavelengths by gains: equalize(ms, {"0.5-1.0": 2.0, "4-": 0.8}).

    Each range is one pass of enhance(), fine ranges first; what no range holds stays. A pass builds its pyramid of what
    the one before left. Everything is checked before the first pass. For eight fixed bands in one pass: equalizer().

    Args:
        ms: the document; the current mesh is changed.
        gains: by range of wavelengths in mesh units, "0.5-1.0", "-0.5" (all that is finer) or "4-" (all that is
            coarser): the factor for the structure in it, 0 to 8: 1 leaves, 0 removes, 2 doubles. Ranges must not
            overlap.
        softness: width of the edges of each range, in octaves; 0 is a sharp edge.

    Raises:
        ValueError: a range that is none or overlaps another one, or a gain that is out of range.
        pymeshlab.PyMeshLabException: the mesh will not do; it says why.
    """
    ranges = sorted((_limits(band), band) for band in gains)
    for ((_, end), band), ((start, _), other) in zip(ranges, ranges[1:]):
        if start < end:
            raise ValueError(f'"{band}" and "{other}" overlap')
    for band, gain in gains.items():
        if not 0 <= gain <= MOST_GAIN:
            raise ValueError(f'the gain of "{band}" is {gain}; it must be 0 to {MOST_GAIN:g}')
    return EqualizeReport(
        bands={
            band: enhance(ms, gain=gains[band], finest=low, coarsest=high, softness=softness)
            for (low, high), band in ranges
        }
    )
