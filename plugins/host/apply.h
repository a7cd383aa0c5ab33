#pragma once

#include "host/api.h"

#include <exception>
#include <functional>
#include <string>
#include <vector>

/// What both filter APIs have in common: the host's view of a table row, and the steps of one call.
namespace multires::host {

/// The row of the action, found by its text (hosts may put an '&' in it).
/// @throws std::logic_error  if the action is not of this plugin
const plugin::Filter& row(const plugin::Plugin& table, const QAction* action);

Interface::FilterClass menu_class(const plugin::Filter& filter);

/// MeshModel::MeshElement bits that a mesh must have.
int precondition(const plugin::Filter& filter);

/// MeshModel::MeshElement bits that a call may change in the current mesh. Hosts offer a preview for them unless the
/// number of vertices is among them, which it is said to be where they could not take the preview back.
int postcondition(const plugin::Filter& filter);

/// The parameters to show for the current mesh; works with an empty document too.
RichParameterList parameters(const plugin::Filter& filter, const MeshDocument& document);

/// Runs the filter on the current mesh. The document is changed at the very end, completely or (whatever is thrown)
/// not at all; nothing but what the Result holds changes. A new layer becomes the current one.
/// @param prepare  gets the report just before the document changes, to do with it what may fail
/// @throws InputError, Cancelled, std::exception, what `prepare` throws: see describe_exception
void apply(const plugin::Filter& filter, const RichParameterList& list, MeshDocument& document,
           vcg::CallBackPos* callback, const std::function<void(const Report&)>& prepare);

/// The exception being handled, in words for the user. Call it in a catch block.
std::string describe_exception();

/// A report as lines for the host's log: the filter's own, then a line for each number.
std::vector<std::string> log_lines(const Report& report);

/// Gives every line to `log`, after the document was changed: if there is no memory for them, the lines are lost.
template <class Log>
void tell(const std::vector<std::string>& lines, const Log& log) noexcept {
    try {
        for (const std::string& line : lines) log(line);
    } catch (const std::exception&) {  // see above
    }
}

}  // namespace multires::host
