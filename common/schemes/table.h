#pragma once

#include "schemes/scheme.h"

#include <memory>
#include <string>
#include <vector>

/// The table of schemes: what the choice `scheme` of all filters holds. CONTRIBUTING.md says how to add one.
namespace multires {

struct SchemeRow {
    std::string name;      ///< in the choice
    std::string summary;   ///< what it is good for, as the tooltip goes on after the name and a colon
    std::string citation;  ///< HTML: authors, title, where and when
    Capabilities capabilities;
    std::unique_ptr<Scheme> (*make)(const Hierarchy& hierarchy, const SchemeOptions& options);
};

/// All schemes. Scripts may refer to them by number: new ones are added at the end.
const std::vector<SchemeRow>& schemes();

/// The number of the row with a name.
/// @throws std::invalid_argument if there is none
int scheme_named(const std::string& name);

std::unique_ptr<Scheme> make_scheme(const Hierarchy& hierarchy, const SchemeOptions& options);

}  // namespace multires
