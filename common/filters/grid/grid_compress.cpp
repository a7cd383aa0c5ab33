#include "filters/grid/grid_compress.h"

#include "mesh/validation.h"

#include <algorithm>
#include <cmath>

namespace multires {
void check(const GridCompressOptions& options) {
    require(options.share > 0 && options.share <= 100, "share must be a percentage, more than 0 and at most 100");
    require(options.error > 0 && std::isfinite(options.error), "error must be a number, more than 0");
}

void CompressionErrors::add(const std::vector<Raster>& error, const std::vector<Raster>& samples) {
    for (std::size_t p = 0; p < error[0].values.size(); ++p) {
        double square = 0;
        for (std::size_t c = 0; c < error.size(); ++c) {
            square += error[c].values[p] * error[c].values[p];
            energy += samples[c].values[p] * samples[c].values[p];
        }
        squares += square;
        largest = std::max(largest, std::sqrt(square));
    }
}

void CompressionErrors::tell(const std::string& label, const std::string& unit, Report& report) const {
    report.add(label + "kept_coefficients", static_cast<int>(kept));
    report.add(label + "kept_share", 100 * kept / vertices, "percent");
    report.add(label + "rms_error", std::sqrt(squares / vertices), unit);
    report.add(label + "largest_error", largest, unit);
    report.add(label + "error_energy", energy > 0 ? 100 * squares / energy : 0, "percent");
}

std::vector<Raster> change_by_compression(const GridSignal& signal, const Grid& grid, const GridPyramid& pyramid,
                                          const GridCompressOptions& options, const Progress& progress,
                                          CompressionErrors& errors) {
    SparseOptions how;
    how.oracle = options.oracle;
    how.keep = static_cast<std::size_t>(options.share / 100 * grid.vertices);
    if (options.keep_by == KeepBy::error) how.error = options.error;
    const Sparse kept = sparse(pyramid, signal.channels(), how, progress);
    std::vector<Raster> change = signal.change_to(kept.samples);
    errors.add(change, signal.channels());
    errors.vertices += grid.vertices, errors.kept += static_cast<double>(kept.kept);
    return change;
}

Result grid_compress(const Layer& layer, const GridCompressOptions& options, Session& session) {
    require_usable(layer.mesh);  // before a default that could not be derived from the mesh is blamed
    check(options);
    Result result;
    const std::vector<double> weights = region_weights(layer, options.region);
    session.progress.report(0, "Finding the grid");
    const FoundGrids found = grids_of(layer, options.grid);
    Positions after = layer.mesh.positions;
    CompressionErrors errors;
    double done = 0;
    for (const Grid& grid : found.grids) {
        const double all = static_cast<double>(layer.mesh.positions.size());
        const Progress part = session.progress.part(0.9 * done / all, 0.9 * (done + grid.vertices) / all);
        done += grid.vertices;
        const GridPyramid pyramid = pyramid_of(grid, options.grid);
        const GridSignal signal(grid, layer.mesh.positions, options.grid.channels);
        signal.add(change_by_compression(signal, grid, pyramid, options, part, errors), after);
    }
    session.progress.report(0.95, "Measuring the change");
    blend(layer.mesh.positions, weights, after);
    errors.tell("", "mesh units", result.report);
    report_change(layer, after, result.report);
    result.positions = std::move(after);
    return result;
}

}  // namespace multires
