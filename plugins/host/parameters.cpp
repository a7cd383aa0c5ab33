#include "host/parameters.h"

#include <algorithm>
#include <cmath>
#include <sstream>

namespace multires::host {
namespace {

using plugin::Hint;

class Declarer final : public plugin::Parameters {
public:
    void boolean(const char* name, bool& value, const Hint& hint) override { add<RichBool>(name, hint, value); }
    void integer(const char* name, int& value, const Hint& hint) override { add<RichInt>(name, hint, value); }
    void real(const char* name, double& value, const Hint& hint) override { add<RichFloat>(name, hint, finite(value)); }
    void slider(const char* name, double& value, const Hint& hint) override {
        add<RichDynamicFloat>(name, hint, finite(value), finite(hint.least), finite(hint.most));
    }
    void choice(const char* name, int& value, const std::vector<std::string>& names, const Hint& hint) override {
        QStringList list;
        for (const std::string& n : names) list << QString::fromStdString(n);
        add<RichEnum>(name, hint, value, list);
    }
    void text(const char* name, std::string& value, const Hint& hint) override {
        add<RichString>(name, hint, QString::fromStdString(value));
    }

    RichParameterList list;

private:
    static Scalarm finite(double value) {
        if (!std::isfinite(static_cast<Scalarm>(value))) throw InputError("no default for this mesh");
        return static_cast<Scalarm>(value);
    }

    template <class Rich, class... Value>
    void add(const char* name, const Hint& hint, const Value&... value) {
        list.addParam(make_parameter<Rich>(QString(name), arranged(hint), value...));
    }

    /// As the dialogs of hosts need it. 2020.09 lists all parameters one below the other, without headings or folding.
    /// Later ones fold the advanced ones away, but not their headings: those get one heading in common, and in all
    /// hosts their group is part of the label.
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

    std::vector<std::string> groups_;  ///< in order of appearance
};

RichParameterList declare(const plugin::Filter& filter, const Layer* layer) {
    Declarer declarer;
    filter.parameters(declarer, layer);
    return declarer.list;
}

[[noreturn]] void refuse(const char* name, const Hint& hint, double value) {
    std::ostringstream message;
    message << "Parameter \"" << name << "\" (" << hint.label << ") is " << value << "; it must be ";
    const bool below = hint.least > -1e300, above = hint.most < 1e300;
    if (below && above)
        message << "between " << hint.least << " and " << hint.most << ".";
    else if (below)
        message << "at least " << hint.least << ".";
    else if (above)
        message << "at most " << hint.most << ".";
    else
        message << "a finite number.";
    throw InputError(message.str());
}

/// `given` if it is in range. Hosts pass reals in single precision: a value that differs from `current` only by that
/// is `current`, and one that leaves the range only by that is the end of the range.
double checked_real(const char* name, double current, double given, const Hint& hint) {
    if (!std::isfinite(given)) refuse(name, hint, given);
    if (static_cast<float>(given) == static_cast<float>(current)) return current;
    const double slack = 1e-6 * std::abs(given);
    if (given < hint.least - slack || given > hint.most + slack) refuse(name, hint, given);
    return std::clamp(given, hint.least, hint.most);
}

}  // namespace

RichParameterList declare_parameters(const plugin::Filter& filter, const Layer* layer) {
    if (layer) try {
            return declare(filter, layer);
        } catch (const std::exception&) {  // see the header
        }
    return declare(filter, nullptr);
}

void ParameterReader::boolean(const char* name, bool& value, const Hint& /*hint*/) {
    if (list_.hasParameter(name)) value = list_.getBool(name);
}

void ParameterReader::integer(const char* name, int& value, const Hint& hint) {
    if (!list_.hasParameter(name)) return;
    const int given = list_.getInt(name);
    if (given < hint.least || given > hint.most) refuse(name, hint, given);
    value = given;
}

void ParameterReader::real(const char* name, double& value, const Hint& hint) {
    if (list_.hasParameter(name)) value = checked_real(name, value, list_.getFloat(name), hint);
}

void ParameterReader::slider(const char* name, double& value, const Hint& hint) {
    if (list_.hasParameter(name)) value = checked_real(name, value, list_.getDynamicFloat(name), hint);
}

void ParameterReader::choice(const char* name, int& value, const std::vector<std::string>& names, const Hint& hint) {
    if (!list_.hasParameter(name)) return;
    const int given = list_.getEnum(name);
    if (given < 0 || given >= static_cast<int>(names.size())) {
        Hint range = hint;
        range.least = 0, range.most = static_cast<double>(names.size()) - 1;
        refuse(name, range, given);
    }
    value = given;
}

void ParameterReader::text(const char* name, std::string& value, const Hint& /*hint*/) {
    if (list_.hasParameter(name)) value = list_.getString(name).toStdString();
}

}  // namespace multires::host
