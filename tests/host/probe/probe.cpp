#include "shared/table.h"

#include <limits>
#include <new>

// A plugin for testing the host adapter: one filter for each kind of parameter, result and failure. It is built twice,
// as PROBE = "probe" and PROBE = "twin", because some things happen only between two plugins. Never installed.

namespace multires {
namespace {

using namespace plugin;

const std::string probe = PROBE;

// ---- parameters ---------------------------------------------------------------------------------

enum class Color { red, green, blue };

struct AllOptions {
    bool flag = true;
    int count = 3;
    double length = 0.1;  // of the box diagonal
    double amount = 0.5;
    Color color = Color::green;
};

AllOptions all_defaults(const Layer* layer) {
    AllOptions o;
    if (!layer) return o;
    Vec3 least = layer->mesh.positions.at(0), most = least;
    for (const Vec3& p : layer->mesh.positions) least = least.cwiseMin(p), most = most.cwiseMax(p);
    o.length = 0.1 * (most - least).norm();
    return o;
}

void bind_all(Parameters& p, AllOptions& o) {
    p.add("flag", &o.flag, "Flag", "true or false");
    p.add("count", &o.count, "Count", "1 to 10").between(1, 10);
    p.add("length", &o.length, "Length", "mesh units, not negative").at_least(0);
    p.add("amount", &o.amount, "Amount", "0 to 1").slider(0, 1).advanced("Advanced things");
    p.add("color", Choice(o.color, {"red", "green", "blue"}), "Color", "one of three");
}

Result report_all(const Layer& layer, const AllOptions& o, Session& session) {
    session.progress.report(0.5, "probing");
    Result r;
    r.report.say("the probe ran");
    r.report.add("flag", o.flag);
    r.report.add("count", o.count);
    r.report.add("length", o.length, "mesh units");
    r.report.add("amount", o.amount);
    r.report.add("color", static_cast<int>(o.color));
    r.report.add("list", std::vector<double>{1, 2.5, 4});
    r.report.add("vertices", static_cast<int>(layer.mesh.positions.size()));
    return r;
}

// ---- results and failures -----------------------------------------------------------------------

enum class Fail { no, input, internal, memory, unknown, cancel, not_finite, wrong_size, wrong_source };

struct ChangeOptions {
    double shift = 1;
    Fail fail = Fail::no;
};

ChangeOptions change_defaults(const Layer*) { return {}; }

void bind_change(Parameters& p, ChangeOptions& o) {
    p.add("shift", &o.shift, "Shift", "mesh units");
    p.add("fail",
          Choice(o.fail, {"no", "input", "internal", "memory", "unknown", "cancel", "not finite", "wrong size",
                          "wrong source"}),
          "Fail", "how to fail");
}

void fail_early(Fail fail) {
    switch (fail) {
    case Fail::input:
        throw InputError("the probe refuses this mesh");
    case Fail::internal:
        throw std::logic_error("a bug in the probe");
    case Fail::memory:
        throw std::bad_alloc();
    case Fail::unknown:
        throw 42;
    case Fail::cancel:
        throw Cancelled();
    default:
        return;
    }
}

/// Everything a result can hold at once, each part with its own way of being wrong.
Result change(const Layer& layer, const ChangeOptions& o, Session&) {
    fail_early(o.fail);
    const auto& mesh = layer.mesh;
    Result r;
    r.positions = mesh.positions;
    for (Vec3& p : *r.positions) p.z() += o.shift;
    if (o.fail == Fail::not_finite) r.positions->back().x() = std::numeric_limits<double>::quiet_NaN();
    r.quality.emplace();
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) r.quality->push_back(static_cast<double>(i));
    if (o.fail == Fail::wrong_size) r.quality->pop_back();
    for (Attribute a : layer.attributes) {
        if (a.kind != AttributeKind::color) continue;
        for (double& value : a.values) value = 255 - value;
        r.attributes.push_back(std::move(a));
    }
    return r;
}

/// A layer of every second face, and its vertices.
Result derive(const Layer& layer, const ChangeOptions& o, Session&) {
    fail_early(o.fail);
    DerivedMesh d;
    d.name = "every second face";
    std::vector<Index> number(layer.mesh.positions.size(), -1);
    for (std::size_t f = 0; f < layer.mesh.faces.size(); f += 2) {
        Face face{};
        for (int k = 0; k < 3; ++k) {
            const Index v = layer.mesh.faces[f][k];
            if (number[v] < 0) {
                number[v] = static_cast<Index>(d.source_vertex.size());
                d.source_vertex.push_back(v);
            }
            face[k] = number[v];
        }
        d.faces.push_back(face);
        d.source_face.push_back(static_cast<Index>(f));
    }
    if (o.fail == Fail::wrong_source) d.source_vertex.back() = static_cast<Index>(layer.mesh.positions.size());
    Result r;
    r.layer = std::move(d);
    if (o.fail == Fail::wrong_size) r.quality.emplace();  // found out after the layer is made
    return r;
}

// ---- what is kept with the mesh -----------------------------------------------------------------

struct KeepOptions {
    double value = 0;
};

KeepOptions keep_defaults(const Layer*) { return {}; }

void bind_keep(Parameters& p, KeepOptions& o) { p.add("value", &o.value, "Value", "what to keep"); }

/// Keeps the pyramid of a triangle whose first coordinates are the number.
Result keep(const Layer&, const KeepOptions& o, Session& session) {
    Layer triangle;
    triangle.mesh.positions = {{o.value, 0, 0}, {o.value, 1, 0}, {o.value, 0, 1}};
    triangle.mesh.faces = {{0, 1, 2}};
    session.pyramids = PyramidCache();
    session.pyramids.put(std::make_shared<const Pyramid>(triangle, PyramidOptions(), Progress()));
    return {};
}

Result kept(const Layer&, const KeepOptions&, Session& session) {
    Result r;
    const auto& all = session.pyramids.all();
    r.report.add("found", !all.empty());
    if (!all.empty()) r.report.add("value", all.front()->coefficients().base.row(0)[0]);
    return r;
}

// ---- the table ----------------------------------------------------------------------------------

Filter row(const std::string& menu_name, const std::string& python_name, MenuClass menu_class, std::uint32_t needs,
           std::uint32_t changes) {
    return {"Multiresolution: " + menu_name + " (" + probe + ")",
            python_name + "_" + probe,
            "Tests the host adapter.<br><i>Nobody</i>, <b>\"Nothing\"</b>, 2000.",
            menu_class,
            needs,
            vertex_color,
            changes};
}

}  // namespace

const Plugin& plugin::table() {
    static const Plugin plugin{
        probe,
        {
            filter(row("Parameters", "compute_parameters", MenuClass::measure, none, none), all_defaults, bind_all,
                   report_all),
            filter(row("Change", "apply_coord_change", MenuClass::smoothing, faces,
                       vertex_positions | vertex_quality | vertex_color),
                   change_defaults, bind_change, change),
            filter(row("Derive", "generate_layer", MenuClass::layer, faces, new_layer), change_defaults, bind_change,
                   derive),
            filter(row("Keep", "compute_keep", MenuClass::measure, none, none), keep_defaults, bind_keep, keep),
            filter(row("Kept", "compute_kept", MenuClass::measure, none, none), keep_defaults, bind_keep, kept),
        }};
    return plugin;
}

}  // namespace multires
