#include "host/parameters.h"

#include <QApplication>

#include <algorithm>
#include <cmath>

namespace multires::host {
namespace {

using namespace plugin;

Scalarm finite(double value) {
    if (!std::isfinite(static_cast<Scalarm>(value))) throw InputError("no default for this mesh");
    return static_cast<Scalarm>(value);
}

Point3m host_point(const Vec3& p) { return {finite(p.x()), finite(p.y()), finite(p.z())}; }

/// Programs without dialogs have no use for sliders, and pymeshlab moves values beyond their ends there in silence.
bool shows_sliders() { return qobject_cast<QApplication*>(QCoreApplication::instance()) != nullptr; }

/// Fills the host's list.
class Declarer {
public:
    explicit Declarer(const MeshDocument& document) : document_(document) {}

    void add(const Parameter& p) {
        std::visit(Overloaded{
                       [&](const bool* value) { add<RichBool>(p, *value); },
                       [&](const int* value) { add<RichInt>(p, *value); },
                       [&](const double* value) { add_real(p, *value); },
                       [&](const std::string* value) { add<RichString>(p, QString::fromStdString(*value)); },
                       [&](const Choice& choice) { add_choice(p, choice); },
                       [&](const Angle& angle) { add<RichFloat>(p, finite(*angle.degrees)); },
                       [&](const Point& point) { add<RichPoint>(p, host_point(*point.at)); },
                       [&](const Direction& direction) { add<RichVector>(p, host_point(*direction.unit)); },
                       [&](const LayerRef*) { add_layer(p); },
                   },
                   p.field);
    }

    RichParameterList list;

private:
    template <class Rich, class... Value>
    void add(const Parameter& p, const Value&... value) {
        list.addParam(make_parameter<Rich>(QString::fromStdString(p.name), arranged(p.hint), value...));
    }

    void add_real(const Parameter& p, double value) {
        if (p.hint.slider && shows_sliders())
            add<RichDynamicFloat>(p, finite(value), finite(p.hint.range->least), finite(p.hint.range->most));
        else
            add<RichFloat>(p, finite(value));
    }

    void add_choice(const Parameter& p, const Choice& choice) {
        QStringList names;
        for (const std::string& n : choice.names) names << QString::fromStdString(n);
        add<RichEnum>(p, choice.value(), names);
    }

    void add_layer(const Parameter& p) {
        const MeshModel* other = document_.mm();
        bool found = false;
        for_each_mesh(document_, [&](const MeshModel& model) {
            if (!found && &model != document_.mm()) other = &model, found = true;
        });
        list.addParam(make_layer_parameter(QString::fromStdString(p.name), arranged(p.hint), other, document_));
    }

    /// As the dialogs of hosts need it. 2020.09 lists all parameters one below the other, without headings (see
    /// fold_2020.h). Later ones fold the advanced ones away, but not their headings: those get one heading in common,
    /// and in all hosts their group is part of the label.
    Hint arranged(Hint hint) {
        if (hint.advanced) {
            if (!hint.group.empty()) hint.label = hint.group + ": " + hint.label;
            hint.group = "Advanced";
        }
        if (hint.group.empty()) return hint;
        auto place = std::find(groups_.begin(), groups_.end(), hint.group);
        if (place == groups_.end()) place = groups_.insert(place, hint.group);
        // Headings are sorted, and shown as rich text: blanks in front put ours in order and cannot be seen.
        constexpr std::ptrdiff_t most = 20;
        const auto index = hint.advanced ? most : std::min(most, place - groups_.begin());
        hint.group.insert(0, static_cast<std::size_t>(most - index), ' ');
        return hint;
    }

    const MeshDocument& document_;
    std::vector<std::string> groups_;  ///< in order of appearance
};

RichParameterList declare(const Filter& filter, const Layer* layer, const MeshDocument& document) {
    const Call call = filter.call(layer);
    Declarer declarer(document);
    for (const Parameter& p : call.parameters) declarer.add(p);
    return declarer.list;
}

/// Reads the host's list, parameter by parameter.
class Reader {
public:
    Reader(const RichParameterList& list, const MeshDocument& document) : list_(list), document_(document) {}

    void read(const Parameter& p) {
        name_ = QString::fromStdString(p.name);
        if (!list_.hasParameter(name_)) return;
        bool* const given = p.given;
        std::visit(Overloaded{
                       [&](bool*) { set(p, list_.getBool(name_)); },
                       [&](int*) { set(p, list_.getInt(name_)); },
                       [&](const double* value) { read_real(p, *value, p.hint.slider && shows_sliders()); },
                       [&](std::string*) { set(p, list_.getString(name_).toStdString()); },
                       [&](const Choice&) { set(p, list_.getEnum(name_)); },
                       [&](const Angle& angle) { read_real(p, *angle.degrees, false); },
                       [&](const Point&) { set(p, vector()); },
                       [&](const Direction&) { set(p, vector()); },
                       [&](LayerRef* ref) { read_layer(p, *ref); },
                   },
                   p.field);
        if (given && is_default(list_.getParameterByName(name_), 0)) *given = false;
    }

    std::vector<const MeshModel*> layers;

private:
    void read_real(const Parameter& p, double current, bool slider) {
        const double value = slider ? list_.getDynamicFloat(name_) : list_.getFloat(name_);
        set(p, static_cast<float>(value) == static_cast<float>(current) ? current : value);
    }

    Vec3 vector() const {
        const Point3m v = read_point(list_, name_);
        return {v[0], v[1], v[2]};
    }

    void read_layer(const Parameter& p, LayerRef& ref) {
        const MeshModel* model = find_layer(list_, name_, document_);
        if (!model)
            throw InputError("Parameter \"" + p.name + "\" (" + p.hint.label + "): there is no layer " +
                             layer_text(list_, name_) + ".");
        ref.place = layers.size();
        layers.push_back(model);
    }

    const RichParameterList& list_;
    const MeshDocument& document_;
    QString name_;
};

}  // namespace

RichParameterList declare_parameters(const Filter& filter, const Layer* layer, const MeshDocument& document) {
    if (layer) try {
            return declare(filter, layer, document);
        } catch (const std::exception&) {  // see the header
        }
    return declare(filter, nullptr, document);
}

std::vector<const MeshModel*> read_parameters(const RichParameterList& list, const Parameters& parameters,
                                              const MeshDocument& document) {
    Reader reader(list, document);
    for (const Parameter& p : parameters) reader.read(p);
    return std::move(reader.layers);
}

}  // namespace multires::host
