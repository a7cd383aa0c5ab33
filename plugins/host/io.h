#pragma once

#include "host/api.h"

#include "stream/decoder.h"
#include "stream/encoder.h"

#include <optional>

namespace multires::host::io {

/// What opening takes: where to stop reading, 0 for nowhere.
void add_open_parameters(RichParameterList& list);
/// What saving takes, see stream::EncodeOptions.
void add_save_parameters(RichParameterList& list);

/// Reads a .mrm file into an empty mesh.
/// @returns  mask of what it holds (vcg::tri::io::Mask)
/// @throws InputError  if the file cannot be read or is damaged before its first mesh; the mesh stays empty
int open(const QString& file, MeshModel& model, const RichParameterList& list);

/// Writes the mesh, with what the mask says of it.
/// @throws InputError
void save(const QString& file, const MeshModel& model, int mask, const RichParameterList& list,
          vcg::CallBackPos* callback);

/// What can be saved, as a mask; and what is by default.
int capability();

inline const char* const description = "Multiresolution stream";
inline const char* const extension = "MRM";

}  // namespace multires::host::io
