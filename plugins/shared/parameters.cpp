#include "shared/parameters.h"

#include "base/number.h"

#include <algorithm>
#include <cmath>

namespace multires::plugin {
namespace {

/// How a message begins.
std::string title(const Parameter& p) { return "Parameter \"" + p.name + "\" (" + p.hint.label + ")"; }

std::string words(const Range& range) {
    const bool below = std::isfinite(range.least), above = std::isfinite(range.most);
    if (below && above) return "between " + number(range.least) + " and " + number(range.most);
    if (below) return "at least " + number(range.least);
    if (above) return "at most " + number(range.most);
    return "a finite number";
}

[[noreturn]] void refuse(const Parameter& p, double value, const Range& range) {
    throw InputError(title(p) + " is " + number(value) + "; it must be " + words(range) + ".");
}

/// `value` if it is in the range, or in single precision: then the end of the range.
double checked(const Parameter& p, double value) {
    const Range range = p.hint.range.value_or(Range());
    const double slack = 1e-6 * std::abs(value);
    if (!std::isfinite(value) || value < range.least - slack || value > range.most + slack) refuse(p, value, range);
    return std::clamp(value, range.least, range.most);
}

void is_given(const Parameter& p) {
    if (p.given) *p.given = true;
}

}  // namespace

Parameter& Parameters::add(std::string name, Field field, std::string label, std::string tooltip) {
    Parameter p{std::move(name), std::move(field), {}};
    p.hint.label = std::move(label);
    p.hint.tooltip = std::move(tooltip);
    return all_.emplace_back(std::move(p));
}

void set(const Parameter& p, bool value) {
    *std::get<bool*>(p.field) = value;
    is_given(p);
}

void set(const Parameter& p, int value) {
    const auto* choice = std::get_if<Choice>(&p.field);
    const Range range =
        choice ? Range{0, static_cast<double>(choice->names.size()) - 1} : p.hint.range.value_or(Range());
    if (value < range.least || value > range.most) refuse(p, value, range);
    if (choice)
        choice->set(value);
    else
        *std::get<int*>(p.field) = value;
    is_given(p);
}

void set(const Parameter& p, double value) {
    const auto* angle = std::get_if<Angle>(&p.field);
    double& field = angle ? *angle->degrees : *std::get<double*>(p.field);
    field = checked(p, value);
    is_given(p);
}

void set(const Parameter& p, std::string value) {
    *std::get<std::string*>(p.field) = std::move(value);
    is_given(p);
}

void set(const Parameter& p, const Vec3& value) {
    if (!value.allFinite()) throw InputError(title(p) + " must be three finite numbers.");
    if (const auto* point = std::get_if<Point>(&p.field)) {
        *point->at = value;
    } else {
        Vec3& unit = *std::get<Direction>(p.field).unit;
        const double largest = value.cwiseAbs().maxCoeff();  // first, for squares of tiny numbers are 0
        if (!(largest > 0)) throw InputError(title(p) + " must not be 0, 0, 0: a direction has a length.");
        unit = (value / largest).normalized();
    }
    is_given(p);
}

}  // namespace multires::plugin
