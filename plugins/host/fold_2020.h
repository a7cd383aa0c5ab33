#pragma once

#include "host/api.h"

/// MeshLab 2020.09 lists all parameters of a filter one below the other. It has no advanced ones to fold away, as its
/// successors do, and a dialog with all of ours is as tall as a screen.
namespace multires::host {

/// Once the dialog that the host is about to open for `filter` stands, moves the rows of its advanced parameters into a
/// box that a button "Advanced" opens and closes. The parameters and their widgets stay what they are, so values,
/// scripts (which the host matches by name and number) and "Default" are as without it. Does nothing in a program
/// without such a dialog (meshlabserver), or if it is not built as that of 2020.09.
void fold_advanced(const plugin::Filter& filter);

}  // namespace multires::host
