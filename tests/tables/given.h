#pragma once

#include "shared/table.h"

#include <cmath>
#include <limits>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace multires::plugin {

/// Reads parameters from a list of values by name, refusing what hosts refuse; those not in the list keep their
/// defaults. Numbers stand for booleans and choices too.
class Given final : public Parameters {
public:
    using Parameters::choice;

    Given() = default;
    explicit Given(std::map<std::string, double> values) : values_(std::move(values)) {}

    void boolean(const char* name, bool& value, const Hint&) override {
        if (const double* v = find(name)) value = *v != 0;
    }
    void integer(const char* name, int& value, const Hint& hint) override {
        // Hosts hold an int.
        Hint range = hint;
        range.least = std::max<double>(hint.least, std::numeric_limits<int>::min());
        range.most = std::min<double>(hint.most, std::numeric_limits<int>::max());
        if (const double* v = checked(name, range)) value = static_cast<int>(*v);
    }
    void real(const char* name, double& value, const Hint& hint) override {
        if (const double* v = checked(name, hint)) value = *v;
    }
    void slider(const char* name, double& value, const Hint& hint) override { real(name, value, hint); }
    void choice(const char* name, int& value, const std::vector<std::string>& names, const Hint&) override {
        Hint range;
        range.least = 0, range.most = static_cast<double>(names.size()) - 1;
        if (const double* v = checked(name, range)) value = static_cast<int>(*v);
    }
    void text(const char*, std::string&, const Hint&) override {}

private:
    const double* find(const char* name) const {
        const auto at = values_.find(name);
        return at == values_.end() ? nullptr : &at->second;
    }
    const double* checked(const char* name, const Hint& hint) const {
        const double* v = find(name);
        if (v && !(std::isfinite(*v) && *v >= hint.least && *v <= hint.most))
            throw InputError(std::string("Parameter \"") + name + "\" is out of range.");
        return v;
    }

    std::map<std::string, double> values_;
};

/// One parameter of a filter, as declared for a layer.
struct Declared {
    enum class Type { boolean, integer, real, choice, text } type;
    std::string name;
    double value, least, most;
};

/// All parameters of a filter.
inline std::vector<Declared> declared(const Filter& filter, const Layer* layer) {
    class Lister final : public Parameters {
    public:
        void boolean(const char* name, bool& value, const Hint&) override {
            list.push_back({Declared::Type::boolean, name, value ? 1.0 : 0.0, 0, 1});
        }
        void integer(const char* name, int& value, const Hint& hint) override {
            list.push_back({Declared::Type::integer, name, static_cast<double>(value), hint.least, hint.most});
        }
        void real(const char* name, double& value, const Hint& hint) override {
            list.push_back({Declared::Type::real, name, value, hint.least, hint.most});
        }
        void slider(const char* name, double& value, const Hint& hint) override { real(name, value, hint); }
        void choice(const char* name, int& value, const std::vector<std::string>& names, const Hint&) override {
            const double last = static_cast<double>(names.size()) - 1;
            list.push_back({Declared::Type::choice, name, static_cast<double>(value), 0, last});
        }
        void text(const char* name, std::string&, const Hint&) override {
            list.push_back({Declared::Type::text, name, 0, 0, 0});
        }
        std::vector<Declared> list;
    };
    Lister lister;
    filter.parameters(lister, layer);
    return std::move(lister.list);
}

}  // namespace multires::plugin
