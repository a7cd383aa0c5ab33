#pragma once

#include "host/api.h"

#include "filters/filter.h"

#include <memory>
#include <set>

namespace multires::host {

/// What a mesh keeps between calls; each may be null or empty.
struct Kept {
    PyramidCache pyramids;
    IntermediateCache intermediates;
    std::shared_ptr<const Original> original;
    std::shared_ptr<const Spline> spline;

    bool empty() const { return pyramids.all().empty() && intermediates.all().empty() && !original && !spline; }
};

/// Where it keeps it: a named per-mesh attribute of vcg, which is not copied with the mesh. It is found by name, so it
/// is common to all our plugins in a process, although each has its own copy of this code; the name says which layout
/// of Kept and what it holds it points to.
///
/// Hosts save it in no file. A VMI file from elsewhere may hold bytes under that name, as an attribute of another type:
/// they are never read, kept() gives nothing and Keeper puts a new slot in their place.
///
/// vcg meshes do not free their attributes, so the document has a list of them (a child of the QObject, by name again),
/// and what deleted meshes kept is released at the next call of a filter, or when the document is destroyed: not at
/// once, for Qt crashes where memory runs out while a signal is connected. The attribute itself, some bytes, stays
/// behind.
///
/// The pyramid's code belongs to the plugin that built it, and hosts unload plugins before they delete meshes; our
/// plugins are therefore linked to stay loaded (-z nodelete).
Kept kept(const CMeshO& mesh);

/// The caches that a mesh keeps, in the hands of one call: what the call lets go of is gone at once, for the mesh does
/// not hold on to it. They go back when this ends, however that is: a cache that holds more, less or the same is no
/// change of the document. The original stays with the mesh.
class Borrowed {
public:
    Borrowed(CMeshO& mesh, Session& to);
    ~Borrowed();
    Borrowed(const Borrowed&) = delete;
    Borrowed& operator=(const Borrowed&) = delete;

private:
    CMeshO& mesh_;
    Session& session_;
};

/// Releases what deleted meshes of the document kept. Cost: number of meshes.
void release_deleted(const MeshDocument& document) noexcept;

struct Slot;

/// The slot to keep it in, made if there is none; one that was made goes again unless it is filled.
class Keeper {
public:
    /// @throws std::bad_alloc
    Keeper(MeshDocument& document, CMeshO& mesh);
    ~Keeper();
    Keeper(const Keeper&) = delete;
    Keeper& operator=(const Keeper&) = delete;

    void keep(Kept what) noexcept;

private:
    void take_back() noexcept;

    using Attributes = std::set<vcg::PointerToAttribute>;

    CMeshO& mesh_;
    Attributes::node_type other_;  // of another type, in the way
    Slot* slot_ = nullptr;
    bool made_ = false;
};

}  // namespace multires::host
