#include "filters/grid/grid_band.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <locale>
#include <sstream>

namespace multires {
namespace {

/// The numbers of a list, as many as there are levels; 1 for those that are left out at the end.
std::vector<double> listed_gains(const std::string& text, int levels) {
    std::string spaced = text;
    std::replace(spaced.begin(), spaced.end(), ',', ' ');
    std::istringstream in(spaced);
    in.imbue(std::locale::classic());  // a decimal point whatever the locale
    std::vector<double> gains;
    while (!(in >> std::ws).eof())
        require(static_cast<bool>(in >> gains.emplace_back()), "gains must be numbers separated by commas");
    gains.resize(levels, 1);
    return gains;
}

/// What gains change of samples.
Raster change_of(const Raster& samples, const GridPyramid& pyramid, const std::vector<double>& gains) {
    Array<double> coefficients = pyramid.analyse(samples);
    for (int k = 0; k < pyramid.levels(); ++k) {
        double* const at = coefficients.data() + pyramid.offset(k, 1);
        for (std::size_t p = 0; p < 7 * pyramid.band_size(k); ++p) at[p] *= gains[k] - 1;
    }
    double* const base = coefficients.data() + pyramid.offset(pyramid.levels() - 1, 0);
    std::fill(base, coefficients.data() + coefficients.size(), 0.0);
    return pyramid.synthesise(coefficients);
}

std::vector<double> energies_of(const GridSignal& signal, const GridPyramid& pyramid) {
    std::vector<double> energy(7 * static_cast<std::size_t>(pyramid.levels()), 0);
    for (const Raster& channel : signal.channels()) {
        const Array<double> x = pyramid.analyse(channel);
        for (int k = 0; k < pyramid.levels(); ++k)
            for (int type = 1; type < subbands; ++type) {
                const double norm = pyramid.norm(k, type), *const at = x.data() + pyramid.offset(k, type);
                double sum = 0;
                for (std::size_t p = 0; p < pyramid.band_size(k); ++p) sum += at[p] * at[p];
                energy[7 * k + type - 1] += norm * norm * sum;
            }
    }
    return energy;
}

void report_energies(const std::vector<double>& energy, const std::vector<LevelInfo>& infos, Report& report) {
    std::vector<double> wavelength;
    report.say("level  wavelength    energy of the types of wavelets 1 to 7");
    for (std::size_t k = 0; 7 * k < energy.size(); ++k) {
        wavelength.push_back(infos[k].wavelength);
        char text[48];
        std::snprintf(text, sizeof text, "%5zu  %-12.6g", k, infos[k].wavelength);
        std::string line = text;
        for (std::size_t type = 0; type < 7; ++type) {
            std::snprintf(text, sizeof text, "  %-9.3g", energy[7 * k + type]);
            line += text;
        }
        report.say(line);
    }
    report.add("wavelength", wavelength, "mesh units");
    report.add("energy", energy, "square mesh units");
}

}  // namespace

std::vector<double> grid_gains(const GridBandOptions& options, const GridPyramid& pyramid, const Layer& layer) {
    require(std::isfinite(options.gain), "gain must be a number");
    if (!options.gains.empty()) return listed_gains(options.gains, pyramid.levels());
    std::vector<double> gains = band_share(level_infos(pyramid, layer), options.band, box_diagonal(layer));
    for (double& g : gains) g = 1 + g * (options.gain - 1);
    return gains;
}

std::vector<Raster> change_by_gains(const GridSignal& signal, const GridPyramid& pyramid,
                                    const std::vector<double>& gains) {
    std::vector<Raster> change;
    for (const Raster& channel : signal.channels()) change.push_back(change_of(channel, pyramid, gains));
    return change;
}

Result compute_grid(const Layer& layer, const ComputeGridOptions& options, Session& session) {
    Result result;
    session.progress.report(0, "Finding the grid");
    const FoundGrids found = grids_of(layer, options.grid);
    std::vector<double> rows, columns, vertices, holes;
    for (const Grid& grid : found.grids) {
        rows.push_back(grid.rows), columns.push_back(grid.columns);
        vertices.push_back(grid.vertices), holes.push_back(count_holes(grid));
    }
    session.progress.report(0.3, "Transforming");
    const GridPyramid pyramid = pyramid_of(found.grids[0], options.grid);
    const GridSignal signal(found.grids[0], layer.mesh.positions, options.grid.channels);
    const std::vector<double> energy = energies_of(signal, pyramid);
    double error = 0;
    for (const Raster& channel : signal.channels()) {
        const Raster again = pyramid.synthesise(pyramid.analyse(channel));
        for (std::size_t p = 0; p < again.values.size(); ++p)
            if (pyramid.mask(0).values[p]) error = std::max(error, std::abs(again.values[p] - channel.values[p]));
    }
    Report& report = result.report;
    report.add("grids", static_cast<int>(found.grids.size()));
    report.add("rows", rows);
    report.add("columns", columns);
    report.add("vertices", vertices);
    report.add("holes", holes);
    report.add("loose_vertices", static_cast<int>(found.loose_vertices));
    report.add("off_lattice_faces", static_cast<int>(found.off_lattice_faces));
    report.add("levels", pyramid.levels());
    report_energies(energy, level_infos(pyramid, layer), report);
    report.add("reconstruction_error", error, "mesh units");
    return result;
}

Result grid_band(const Layer& layer, const GridBandOptions& options, Session& session) {
    Result result;
    const std::vector<double> weights = region_weights(layer, options.region);
    const Start start(layer, options.relative_to, session, result.report);
    session.progress.report(0, "Finding the grid");
    const FoundGrids found = grids_of(start.layer(), options.grid);
    Positions after = start.layer().mesh.positions;
    std::vector<double> reported;
    for (std::size_t g = 0; g < found.grids.size(); ++g) {
        const double share = 0.8 / static_cast<double>(found.grids.size());
        session.progress.report(0.1 + share * static_cast<double>(g), "Transforming");
        const GridPyramid pyramid = pyramid_of(found.grids[g], options.grid);
        const std::vector<double> gains = grid_gains(options, pyramid, start.layer());
        if (g == 0) reported = gains;
        if (std::all_of(gains.begin(), gains.end(), [](double x) { return x == 1; })) continue;
        const GridSignal signal(found.grids[g], start.layer().mesh.positions, options.grid.channels);
        signal.add(change_by_gains(signal, pyramid, gains), after);
    }
    session.progress.report(0.95, "Measuring the change");
    blend(layer.mesh.positions, weights, after);
    result.report.add("grids", static_cast<int>(found.grids.size()));
    result.report.add("gains", reported);
    report_change(layer, after, result.report);
    result.positions = std::move(after);
    return result;
}

}  // namespace multires
