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
    /// The hierarchy it needs, instead of one of collapses; null: any will do. Throws InputError, naming `scheme`, for
    /// meshes that it is not for.
    Hierarchy (*own_hierarchy)(const Mesh& mesh, const HierarchyOptions& options) = nullptr;
};

/// All schemes. Scripts may refer to them by number: new ones are added at the end.
const std::vector<SchemeRow>& schemes();

/// The number of the row with a name.
/// @throws std::invalid_argument if there is none
int scheme_named(const std::string& name);

/// @throws InputError  naming `scheme` unless it takes Synthesis::from and values
void require_starts_anywhere(const SchemeOptions& options);

std::unique_ptr<Scheme> make_scheme(const Hierarchy& hierarchy, const SchemeOptions& options);

}  // namespace multires
