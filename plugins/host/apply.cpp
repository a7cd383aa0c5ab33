#include "host/apply.h"

#include "host/document.h"
#include "host/kept_pyramid.h"
#include "host/parameters.h"

#include "base/free_memory.h"
#include "filters/original.h"

#include <array>
#include <chrono>
#include <cmath>
#include <iomanip>
#include <map>
#include <new>
#include <sstream>
#include <utility>

namespace multires::host {
namespace {

using plugin::Filter;

MeshModel& current_mesh(const Filter& filter, MeshDocument& document) {
    MeshModel* model = document.mm();
    require(model != nullptr, "There is no mesh: load one, or select a layer.");
    require(model->cm.vn > 0, "The current mesh is empty.");
    require(!(filter.needs & plugin::faces) || model->cm.fn > 0,
            "The current mesh has no faces: this filter needs a triangle mesh, not a point cloud.");
    const auto needs = [&](plugin::Parts part, int element, const char* message) {
        require(!(filter.needs & part) || model->hasDataMask(element), message);
    };
    needs(plugin::vertex_quality, MeshModel::MM_VERTQUALITY, "The current mesh has no vertex quality.");
    needs(plugin::vertex_color, MeshModel::MM_VERTCOLOR, "The current mesh has no vertex colours.");
    needs(plugin::vertex_texcoord, MeshModel::MM_VERTTEXCOORD, "The current mesh has no vertex texture coordinates.");
    needs(plugin::wedge_texcoord, MeshModel::MM_WEDGTEXCOORD, "The current mesh has no wedge texture coordinates.");
    return *model;
}

/// The layers that a call names, read once each; the current one is there already.
class OtherLayers {
public:
    OtherLayers(const plugin::Filter& filter, const std::vector<const MeshModel*>& models, const MeshModel& current,
                const VcgLayer& flat) {
        for (const MeshModel* model : models) {
            if (model != &current && read_.count(model) == 0) read_.emplace(model, read_other(filter, *model));
            layers_.push_back(model == &current ? &flat.layer : &read_.at(model).layer);
        }
    }
    const std::vector<const Layer*>& layers() const { return layers_; }

private:
    static VcgLayer read_other(const plugin::Filter& filter, const MeshModel& model) {
        try {
            return read_other_layer(filter, model);
        } catch (const InputError& e) {
            throw InputError("Layer \"" + model.label().toStdString() + "\": " + e.what());
        }
    }

    std::map<const MeshModel*, VcgLayer> read_;
    std::vector<const Layer*> layers_;
};

/// Passes progress on when the percentage changes, and at least every tenth of a second: a host redraws each time.
Progress progress_of(vcg::CallBackPos* callback) {
    if (!callback) return Progress();
    using Clock = std::chrono::steady_clock;
    return Progress([callback, last = -1, when = Clock::time_point()](int percent, const char* what) mutable {
        const auto now = Clock::now();
        if (percent == last && now - when < std::chrono::milliseconds(100)) return true;
        last = percent, when = now;
        return callback(percent, what);
    });
}

/// To the precision that the host stores.
void round_to_host(Positions& positions) {
    // By way of memory: GCC 12 drops a conversion to float and straight back where it vectorises at -O3.
    std::vector<std::array<Scalarm, 3>> stored(positions.size());
    for (std::size_t i = 0; i < positions.size(); ++i)
        for (int k = 0; k < 3; ++k) stored[i][k] = static_cast<Scalarm>(positions[i][k]);
    for (std::size_t i = 0; i < positions.size(); ++i)
        for (int k = 0; k < 3; ++k) positions[i][k] = stored[i][k];
}

std::string text(const Report::Value& value) {
    std::ostringstream out;
    out << std::boolalpha;
    const auto number = [&](double x) {  // whole numbers with all their digits
        const bool whole = std::abs(x) < 1e16 && x == std::round(x);
        out << std::setprecision(whole ? 16 : 6) << x;
    };
    std::visit(
        [&](const auto& v) {
            using Type = std::decay_t<decltype(v)>;
            if constexpr (std::is_same_v<Type, std::vector<double>>)
                for (std::size_t i = 0; i < v.size(); ++i) out << (i ? " " : ""), number(v[i]);
            else if constexpr (std::is_same_v<Type, double>)
                number(v);
            else
                out << v;
        },
        value);
    return out.str();
}

}  // namespace

const Filter& row(const plugin::Plugin& table, const QAction* action) {
    const std::string name = action->text().remove('&').toStdString();
    for (const Filter& filter : table.filters)
        if (filter.name == name) return filter;
    throw std::logic_error("no filter \"" + name + "\" in " + table.name);
}

Interface::FilterClass menu_class(const Filter& filter) {
    switch (filter.menu_class) {
    case plugin::MenuClass::smoothing:
        return Interface::Smoothing;
    case plugin::MenuClass::remeshing:
        return Interface::Remeshing;
    case plugin::MenuClass::quality:
        return Interface::Quality;
    case plugin::MenuClass::layer:
        return Interface::Layer;
    case plugin::MenuClass::measure:
        return Interface::Measure;
    case plugin::MenuClass::texture:
        return Interface::Texture;
    }
    throw std::logic_error("filter without a menu class");
}

int precondition(const Filter& filter) {
    const auto bits = [&](plugin::Parts part, int elements) { return filter.needs & part ? elements : 0; };
    return bits(plugin::faces, MeshModel::MM_FACENUMBER) | bits(plugin::vertex_quality, MeshModel::MM_VERTQUALITY) |
           bits(plugin::vertex_color, MeshModel::MM_VERTCOLOR) |
           bits(plugin::vertex_texcoord, MeshModel::MM_VERTTEXCOORD) |
           bits(plugin::wedge_texcoord, MeshModel::MM_WEDGTEXCOORD);
}

int postcondition(const Filter& filter) {
    const auto bits = [&](plugin::Parts part, int elements) { return filter.changes & part ? elements : 0; };
    const int changed =
        bits(plugin::vertex_positions, MeshModel::MM_VERTCOORD | MeshModel::MM_VERTNORMAL | MeshModel::MM_FACENORMAL) |
        bits(plugin::faces, MeshModel::MM_FACENUMBER | MeshModel::MM_VERTNUMBER) |
        bits(plugin::vertex_quality, MeshModel::MM_VERTQUALITY) | bits(plugin::vertex_color, MeshModel::MM_VERTCOLOR) |
        bits(plugin::vertex_texcoord, MeshModel::MM_VERTTEXCOORD) |
        bits(plugin::wedge_texcoord, MeshModel::MM_WEDGTEXCOORD) |
        bits(plugin::vertex_selection, MeshModel::MM_VERTFLAGSELECT) |
        bits(plugin::edge_selection, MeshModel::MM_FACEFLAGSELECT);
    const bool lasting =
        filter.changes & (plugin::new_layer | plugin::vertex_texcoord | plugin::wedge_texcoord |
                          plugin::custom_attributes | plugin::vertex_selection | plugin::edge_selection);
    return lasting && changed ? changed | MeshModel::MM_VERTNUMBER : changed;
}

RichParameterList parameters(const Filter& filter, const MeshDocument& document) {
    const MeshModel* model = document.mm();
    if (!model || model->cm.vn == 0) return declare_parameters(filter, nullptr, document);
    try {
        const VcgLayer flat = read_layer(filter, *model);
        return declare_parameters(filter, &flat.layer, document);
    } catch (const std::exception&) {  // reported when the filter runs
        return declare_parameters(filter, nullptr, document);
    }
}

namespace {

/// What a filter used for a while goes back to the system, if it is much: little is there for the next filter, which
/// would take longer to get it back than to use it.
struct MemoryGoesBack {
    ~MemoryGoesBack() { return_free_memory(64 << 20); }
};

}  // namespace

void apply(const Filter& filter, const RichParameterList& list, MeshDocument& document, vcg::CallBackPos* callback,
           const std::function<void(const Report&)>& prepare) {
    const MemoryGoesBack at_end;
    release_deleted(document);
    MeshModel& model = current_mesh(filter, document);
    VcgLayer flat = read_layer(filter, model);

    Session session;
    session.progress = progress_of(callback);
    session.let_mesh_go = [&] { flat.layer.mesh = Mesh(); };
    session.position = [&](Index i) {
        const auto& p = model.cm.vert[flat.host_vertex[i]].cP();
        return Vec3(p[0], p[1], p[2]);
    };
    const Borrowed borrowed(model.cm, session);
    const Kept before = kept(model.cm);
    session.original = before.original;
    session.spline = before.spline;
    const plugin::Call call = filter.call(&flat.layer);
    const OtherLayers others(filter, read_parameters(list, call.parameters, document), model, flat);
    Result result = call.run({flat.layer, others.layers()}, session);

    Kept after{session.pyramids, session.intermediates, session.original, session.spline};
    if (result.positions) {
        round_to_host(*result.positions);  // so that the shape is known again when it is read
        after.original = original_after(session.original.get(), flat.layer.mesh, *result.positions);
    }
    PendingResult pending(document, model, flat, std::move(result), std::move(after));
    prepare(pending.report());
    pending.commit();
}

std::string describe_exception() {
    try {
        throw;
    } catch (const Cancelled&) {
        return "Cancelled: nothing was changed.";
    } catch (const std::bad_alloc&) {
        return "Not enough memory: nothing was changed.";
    } catch (const InputError& e) {
        return e.what();
    } catch (const std::exception& e) {
        return std::string("Internal error, nothing was changed: ") + e.what();
    } catch (...) {
        return "Internal error, nothing was changed.";
    }
}

std::vector<std::string> log_lines(const Report& report) {
    std::vector<std::string> lines = report.lines();
    for (const Report::Entry& entry : report.entries())
        lines.push_back(entry.key + ": " + text(entry.value) + (entry.unit.empty() ? "" : " " + entry.unit));
    return lines;
}

}  // namespace multires::host
