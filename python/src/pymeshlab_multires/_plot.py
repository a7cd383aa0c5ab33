"""The spectrum of a pyramid as a picture; needs matplotlib."""

from typing import Any

from ._filters import BuildPyramidReport


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
