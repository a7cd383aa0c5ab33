#pragma once

#include "host/api.h"

#include "mesh/mesh.h"

#include <iosfwd>
#include <string>
#include <vector>

/// A host for tests: loads the plugins as MeshLab does and makes documents, without a window or Python.
namespace multires::host_tests {

/// A filter of a loaded plugin.
struct Action {
    FilterPlugin* plugin = nullptr;
    QAction* action = nullptr;
    std::string name;  ///< as in Python
    friend std::ostream& operator<<(std::ostream& out, const Action& a);
};

/// All filters of all plugins in <build>/plugins.
const std::vector<Action>& actions();

/// Ends them all; actions are of no more use.
void unload();

/// @throws std::logic_error  if there is none
const Action& action_named(const std::string& name);

RichParameterList parameters_of(const Action& action, const MeshDocument& document);

/// The same, but pyramids of small meshes have several levels.
RichParameterList small_parameters_of(const Action& action, const MeshDocument& document);

/// Adds a layer with a mesh.
MeshModel& add(MeshDocument& document, const Mesh& mesh, const char* label = "mesh");

/// Switches on all data that filters read or a new layer takes over, with values that differ from element to element.
void enrich(MeshModel& model);

enum class Content {
    everything,  ///< a small surface with every data
    bare,        ///< the same with no optional data at all
    large        ///< with every data, and so many vertices that arrays of them are made of whole pages
};

/// Two layers, the second current: a surface with a boundary, selections and deleted elements; one that the filter
/// takes.
void fill(MeshDocument& document, const Action& action, Content content = Content::everything);

}  // namespace multires::host_tests
