#pragma once

#include "filters/filter.h"

#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

/// The parameters of a filter as data: one list that hosts, tests and documentation walk through. Each entry points to
/// a field of the filter's options: what is in the field is the default, and what a host was given is written to it.
namespace multires::plugin {

/// Sensible values, inclusive.
struct Range {
    double least = -std::numeric_limits<double>::infinity();
    double most = std::numeric_limits<double>::infinity();
};

/// Texts of a parameter for dialogs and docs, and the limits of its values.
struct Hint {
    std::string label;
    std::string tooltip;         ///< what a value does, and in which unit
    std::optional<Range> range;  ///< of numbers, where it means something
    std::string group;           ///< heading in the dialog, where the host has headings
    bool advanced = false;       ///< folded away in the dialog
    bool derived = false;        ///< the default is derived from the mesh
    bool slider = false;         ///< of a real with a range of two ends: a slider, live in hosts that preview
};

/// One of several names: a field of an enum whose values are 0, 1, ... in the order of the names.
class Choice {
public:
    template <class Enum>
    Choice(Enum& field, std::vector<std::string> all)
        : names(std::move(all)), field_(&field),
          get_([](const void* f) { return static_cast<int>(*static_cast<const Enum*>(f)); }),
          set_([](void* f, int value) { *static_cast<Enum*>(f) = static_cast<Enum>(value); }) {}

    int value() const { return get_(field_); }
    void set(int value) const { set_(field_, value); }

    std::vector<std::string> names;

private:
    void* field_;
    int (*get_)(const void*);
    void (*set_)(void*, int);
};

/// An angle in degrees.
struct Angle {
    double* degrees;
};

/// A point in the coordinates of the current layer.
struct Point {
    Vec3* at;
};

/// A direction in the coordinates of the current layer: of any length but 0 when given, of length 1 in the field.
struct Direction {
    Vec3* unit;
};

using Field = std::variant<bool*, int*, double*, std::string*, Choice, Angle, Point, Direction, LayerRef*>;

struct Parameter {
    std::string name;  ///< snake_case, the same in every host
    Field field;
    Hint hint;
    bool* given = nullptr;  ///< if not null: set where the value comes from the caller and is not just the default

    // So that a row reads: p.add("gain", &o.gain, "Gain", "...").slider(0, 10).in("Band");
    Parameter& between(double least, double most) { return hint.range = Range{least, most}, *this; }
    Parameter& at_least(double least) { return hint.range = Range{least}, *this; }
    Parameter& slider(double least, double most) { return hint.slider = true, between(least, most); }
    Parameter& in(std::string group) { return hint.group = std::move(group), *this; }
    Parameter& advanced(std::string group) { return hint.advanced = true, in(std::move(group)); }
    Parameter& derived() { return hint.derived = true, *this; }
    /// Derived from the mesh, and `was_given` is set if the caller passes another value.
    Parameter& derived(bool& was_given) { return given = &was_given, derived(); }
};

/// The list, in the order in which dialogs show it.
class Parameters {
public:
    /// @param field  a pointer to bool, int, double, std::string or LayerRef; Choice, Angle, Point or Direction
    /// The reference is good until the next parameter is added.
    Parameter& add(std::string name, Field field, std::string label, std::string tooltip);

    auto begin() const { return all_.begin(); }
    auto end() const { return all_.end(); }
    std::size_t size() const { return all_.size(); }
    const Parameter& operator[](std::size_t i) const { return all_[i]; }

private:
    std::vector<Parameter> all_;
};

/// Writes a value to a parameter's field, and that it was given.
/// Overloads: whole numbers (for int, and as the place of a choice's name), reals (for double and Angle), vectors (for
/// Point and Direction); a bool, a text and a LayerRef need no check and are written as they are.
/// @throws InputError  naming the parameter and its range: out of range, not finite, or a direction without a length
/// @throws std::bad_variant_access  for a field of another type
void set(const Parameter& p, bool value);
void set(const Parameter& p, int value);
void set(const Parameter& p, double value);
void set(const Parameter& p, std::string value);
void set(const Parameter& p, const Vec3& value);

/// Helper for std::visit: one function object from several lambdas.
template <class... Functions>
struct Overloaded : Functions... {
    using Functions::operator()...;
};
template <class... Functions>
Overloaded(Functions...) -> Overloaded<Functions...>;

}  // namespace multires::plugin
