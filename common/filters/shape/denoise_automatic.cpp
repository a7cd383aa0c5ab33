#include "filters/shape/denoise_automatic.h"

#include "denoise/automatic.h"

#include <algorithm>
#include <cstdio>

namespace multires {
namespace {

/// What each kind of candidate contributed.
struct Shares {
    double linear = 0, wiener = 0, field = 0, guided = 0;
    double kept() const { return std::max(0.0, 1 - linear - wiener - field - guided); }
};

Shares shares_of(const Eigen::VectorXd& weights) {
    Shares shares;
    if (weights.size() == 0) return shares;
    const std::vector<Candidate> all = all_candidates();
    for (std::size_t k = 0; k < all.size(); ++k) {
        const double t = weights[static_cast<Eigen::Index>(k)];
        switch (all[k].family) {
        case Family::low_pass:
            shares.linear += t;
            break;
        case Family::wiener:
            shares.wiener += t;
            break;
        case Family::normal_field:
            shares.field += t;
            break;
        case Family::guided_normals:
            shares.guided += t;
            break;
        }
    }
    return shares;
}

template <class... Numbers>
std::string text(const char* format, Numbers... numbers) {
    char line[256];
    std::snprintf(line, sizeof line, format, numbers...);
    return line;
}

void tell(const AutomaticStats& stats, const Shares& shares, Report& report) {
    constexpr double nearly_all = 0.95;
    if (stats.by_edges < nearly_all)
        report.say(
            text("The edges follow the details, as those of a coarse mesh do and noise does not: %.0f %% of what "
                 "looks like noise is taken for shape.",
                 100 * (1 - stats.by_edges)));
    if (stats.outliers > 0)
        report.say(text(stats.outliers == 1 ? "%d single vertex far off the surface was put back."
                                            : "%d single vertices far off the surface were put back.",
                        static_cast<int>(stats.outliers)));
    if (stats.spikes > 0)
        report.say(text("%d vertices were impulses and were set back.", static_cast<int>(stats.spikes)));
    if (stats.weights.size() == 0) {
        const bool some = stats.outliers + stats.spikes > 0;
        report.say(std::string(some ? "No other noise was found" : "No noise was found") +
                   (stats.deviation > 1e-3 * stats.edge ? " that can be told from the shape" : "") +
                   (some ? "." : "; the mesh stays as it is."));
        return;
    }
    if (stats.voxels)
        report.say(text("The boundary of voxels of %.4g edge lengths: its stairs are noise, and no vertex goes farther "
                        "than half a voxel.",
                        2 * stats.step / stats.edge));
    else if (stats.step > 0)
        report.say(text("The coordinates were rounded to steps of %.4g edge lengths: no vertex leaves its cell.",
                        stats.step / stats.edge));
    if (stats.patches > 0)
        report.say(text("%d planes and curved patches explain the %s places: vertices were moved into them.",
                        static_cast<int>(stats.patches), stats.step > 0 ? "rounded" : "noisy"));
    report.say(text("Noise of %.3g edge lengths along the normals%s%s.", stats.deviation / stats.edge,
                    stats.all_directions ? " and within the surface" : "",
                    stats.axis ? ", most of it along one axis of space" : ""));
    if (stats.varies)
        report.say(text("It varies over the surface, from %.3g to %.3g edge lengths, and so does what is done.",
                        stats.least_deviation / stats.edge, stats.most_deviation / stats.edge));
    if (stats.kinds) report.say("There are two kinds of surface, and each has a blend of its own.");
    report.say(text("Blend: %.0f %% low pass, %.0f %% local Wiener filter, %.0f %% normal field (piecewise smooth), "
                    "%.0f %% guided normals after it (creases), %.0f %% unchanged.",
                    100 * shares.linear, 100 * shares.wiener, 100 * shares.field, 100 * shares.guided,
                    100 * shares.kept()));
    report.say(text("Expected RMS distance from the truth: %.3g edge lengths before, %.3g after.",
                    stats.rms_before / stats.edge, stats.rms_after / stats.edge));
}

}  // namespace

Positions by_automatic(const Layer& layer, const DenoiseOptions& o, double given, const Session& session,
                       Report& report) {
    AutomaticStats stats;
    Positions after = layer.mesh.positions;
    if (o.strength > 0) {
        AutomaticOptions options;
        options.strength = o.strength;
        options.fast = o.fast;
        if (o.unit != ThresholdUnit::automatic) options.deviation = given;
        const Progress part = session.progress.part(0, 0.97);
        after = denoise_automatically(layer.mesh.faces, layer.mesh.positions, options, stats,
                                      [&](double f, const char* what) { part.report(f, what); });
    }
    const Shares shares = shares_of(stats.weights);
    report.add("noise", o.strength > 0 ? stats.deviation / o.strength : 0.0, "mesh units");
    report.add("noise_in_edges", o.strength > 0 && stats.edge > 0 ? stats.deviation / o.strength / stats.edge : 0.0);
    report.add("noise_least", o.strength > 0 ? stats.least_deviation / o.strength : 0.0, "mesh units");
    report.add("noise_most", o.strength > 0 ? stats.most_deviation / o.strength : 0.0, "mesh units");
    report.add("noise_in_all_directions", stats.all_directions);
    report.add("noise_along_axis", stats.axis);
    report.add("rounding_step", stats.step, "mesh units");
    report.add("spikes_removed", static_cast<int>(stats.outliers + stats.spikes));
    report.add("estimated_rms_before", stats.rms_before, "mesh units");
    report.add("estimated_rms_after", stats.rms_after, "mesh units");
    report.add("share_low_pass", shares.linear);
    report.add("share_wiener", shares.wiener);
    report.add("share_normal_field", shares.field);
    report.add("share_guided_normals", shares.guided);
    if (o.strength > 0) tell(stats, shares, report);
    return after;
}

}  // namespace multires
