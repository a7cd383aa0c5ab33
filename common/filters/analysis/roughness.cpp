#include "filters/analysis/roughness.h"

#include "base/parallel.h"
#include "filters/analysis/heights.h"
#include "filters/calibration.h"
#include "filters/region.h"
#include "measure/measure.h"
#include "mesh/validation.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace multires {
namespace {

constexpr int bins = 100;

void check(const RoughnessOptions& o) {
    require(std::isfinite(o.s_filter) && o.s_filter >= 0, "s_filter must be a number, 0 or more");
    require(std::isfinite(o.l_filter) && o.l_filter >= 0, "l_filter must be a number, 0 or more");
    require(o.form != RoughnessForm::low_pass || o.l_filter > 0,
            "l_filter must be more than 0: with form=low pass heights count from the low pass at that wavelength");
    require(o.l_filter == 0 || o.l_filter > o.s_filter, "l_filter must be more than s_filter");
}

/// The faces that count.
Faces chosen_faces(const Layer& layer, bool selected) {
    if (!selected) return layer.mesh.faces;
    const std::vector<double> weight = region_weights(layer, {true, false});
    Faces faces;
    for (const Face& f : layer.mesh.faces)
        if (weight[f[0]] > 0 && weight[f[1]] > 0 && weight[f[2]] > 0) faces.push_back(f);
    require(!faces.empty(), "selected: no face lies within the selection");
    return faces;
}

/// A mesh of these faces alone.
Mesh cut_out(const Mesh& mesh, Faces faces) {
    Mesh out;
    std::vector<Index> number(mesh.positions.size(), -1);
    for (Face& f : faces)
        for (Index& v : f) {
            if (number[v] < 0) {
                number[v] = static_cast<Index>(out.positions.size());
                out.positions.push_back(mesh.positions[v]);
            }
            v = number[v];
        }
    out.faces = std::move(faces);
    return out;
}

/// Without those in the strip along open rims where the low pass, for want of what is beyond, leans on the rim; all of
/// them, if that is all there is.
Faces away_from_rim(const Mesh& mesh, Faces faces, double l_filter, Report& report) {
    const std::vector<double> distance = distance_from_rim(mesh, l_filter / 2);
    const auto near = [&](const Face& f) {
        return std::min({distance[f[0]], distance[f[1]], distance[f[2]]}) < l_filter / 2;
    };
    const auto end = std::stable_partition(faces.begin(), faces.end(), [&](const Face& f) { return !near(f); });
    if (end == faces.begin())
        report.say("Every face lies nearer to an open rim than half of l_filter: heights lean on the rim.");
    else
        faces.erase(end, faces.end());
    return faces;
}

Heights over_low_pass(const Layer& layer, const RoughnessOptions& o, Faces faces, Session& session, Report& report) {
    const auto spline = spline_of(layer, {}, session, report);
    const TextureBand band{o.order, {o.s_filter, "s_filter"}, {o.l_filter, "l_filter"}};
    Heights out = heights_over_low_pass(*spline, layer.mesh, band, session.progress.part(0.3, 0.9));
    out.reference.faces = away_from_rim(layer.mesh, std::move(faces), o.l_filter, report);
    return out;
}

Heights over_form(const Mesh& all, const RoughnessOptions& o, Faces faces, Session& session, Report& report) {
    const Mesh mesh = cut_out(all, std::move(faces));
    require_usable(mesh);
    session.progress.report(0, "Fitting the form");
    const Form form = fit_form(static_cast<FormKind>(o.form), mesh, vertex_areas(mesh));
    if (form.kind == FormKind::sphere || form.kind == FormKind::cylinder)
        report.add("form_radius", form.radius, "mesh units");
    const Index n = static_cast<Index>(mesh.positions.size());
    Heights out;
    out.reference = mesh;
    Array<double> h(n), low(n);
    parallel_for(n, [&](Index i) {
        const FormFoot f = foot(form, mesh.positions[i]);
        out.reference.positions[i] = f.at;
        h[i] = f.height;
    });
    if (o.s_filter > 0 || o.l_filter > 0) {
        const Spline spline(out.reference, {}, session.progress.part(0.1, 0.3));
        const auto smooth = [&](double cutoff, const char* parameter, double begin) {
            spline.low_pass({o.order, cutoff}, ConstRows(h, 1), Rows(low, 1), parameter,
                            session.progress.part(begin, begin + 0.3));
        };
        if (o.s_filter > 0) smooth(o.s_filter, "s_filter", 0.3), h.swap(low);
        if (o.l_filter > 0) {
            smooth(o.l_filter, "l_filter", 0.6);
            for (Index i = 0; i < n; ++i) h[i] -= low[i];
        }
    }
    out.height.assign(h.begin(), h.end());
    return out;
}

void tell(const Texture& t, Report& report) {
    report.add("area", t.area, "square mesh units");
    const char* const length = "mesh units";
    report.add("sa", t.sa, length);
    report.add("sq", t.sq, length);
    report.add("sp", t.sp, length);
    report.add("sv", t.sv, length);
    report.add("sz", t.sz, length);
    report.add("ssk", t.ssk);
    report.add("sku", t.sku);
    report.add("sdq", t.sdq);
    report.add("sdr", t.sdr, "percent");
    report.add("heights", t.limits, length);
    report.add("shares", t.shares);
}

}  // namespace

Result roughness(const Layer& layer, const RoughnessOptions& options, Session& session) {
    require_usable(layer.mesh);
    check(options);
    Result result;
    Faces faces = chosen_faces(layer, options.selected);
    const Heights heights = options.form == RoughnessForm::low_pass
                                ? over_low_pass(layer, options, std::move(faces), session, result.report)
                                : over_form(layer.mesh, options, std::move(faces), session, result.report);
    session.progress.report(0.95, "Adding up");
    const Texture texture = texture_of(heights, bins);
    require(texture.area > 0, "l_filter: nothing of the surface is left to measure heights from");
    tell(texture, result.report);
    return result;
}

}  // namespace multires
