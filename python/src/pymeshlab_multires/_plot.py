"""Reports as pictures; needs matplotlib."""

from typing import Any

import numpy as np

from ._filters import BuildPyramidReport, RoughnessReport


def plot_spectrum(report: BuildPyramidReport, ax: Any = None, **line: Any) -> Any:
    """Draws the RMS detail of each level over its wavelength, both logarithmic; plot several for comparison.

    Args:
        report: what build_pyramid() returned.
        ax: the matplotlib axes to draw in; None: the current ones.
        line: passed on to matplotlib's plot, for example label="after denoising".

    Returns:
        the axes.

    Raises:
        ImportError: matplotlib is not installed (pip install "pymeshlab-multires[plot]").
    """
    if ax is None:
        import matplotlib.pyplot as plt  # type: ignore[import-not-found, unused-ignore]

        ax = plt.gca()
    drawn = report.rms_detail > 0  # the coarsest level has no details
    ax.loglog(report.wavelength[drawn], report.rms_detail[drawn], **{"marker": "o", "markersize": 3.5, **line})
    ax.set_xlabel("wavelength, mesh units")
    ax.set_ylabel("RMS detail, mesh units")
    ax.grid(True, which="major", alpha=0.3)
    return ax


def plot_roughness(report: RoughnessReport, ax: Any = None, **line: Any) -> Any:
    """Draws the heights of a surface: how much of the area has which height, and the bearing curve (Abbott and
    Firestone), the share of the area that is as high or higher.

    Args:
        report: what roughness() returned.
        ax: the matplotlib axes to draw in; None: the current ones.
        line: passed on to matplotlib's plot for the bearing curve.

    Returns:
        the axes: heights upwards, percent of the area to the right.

    Raises:
        ImportError: matplotlib is not installed (pip install "pymeshlab-multires[plot]").
    """
    if ax is None:
        import matplotlib.pyplot as plt  # type: ignore[import-not-found, unused-ignore]

        ax = plt.gca()
    middle = (report.heights[:-1] + report.heights[1:]) / 2
    most = max(report.shares.max(), 1e-300)
    ax.barh(middle, 50 * report.shares / most, height=np.diff(report.heights), color="0.82", zorder=1)
    bearing = 100 * np.concatenate([[1], 1 - np.cumsum(report.shares)])
    ax.plot(bearing, report.heights, **{"linewidth": 1.8, "zorder": 2, **line})
    ax.set_xlim(0, 100)
    ax.set_xlabel("area as high or higher, % (bars: how common a height is)")
    ax.set_ylabel("height, mesh units")
    ax.set_title(f"Sa {report.sa:.3g}, Sq {report.sq:.3g}, Sz {report.sz:.3g}", fontsize="medium")
    ax.grid(True, alpha=0.3)
    return ax
