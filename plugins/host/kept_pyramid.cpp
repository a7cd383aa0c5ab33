#include "host/kept_pyramid.h"

#include <QObject>

#include <algorithm>
#include <iterator>
#include <memory>
#include <utility>

namespace multires::host {

/// What the attribute holds. A type of its own, and a named one: typeid tells it from anything else of that name and
/// size, also across plugins.
struct Slot {
    Slot() = default;
    Slot(const Slot&) = delete;
    Slot& operator=(const Slot&) = delete;
    ~Slot() {
        if (all) all->erase(this);
    }

    Kept kept;
    std::set<Slot*>* all = nullptr;  ///< the document's list that it is in
};

namespace {

// Change the numbers with the layout of Slot, Pyramid, Original or anything they hold: plugins of different builds
// may meet.
constexpr const char* attribute_name = "multires_kept_5";
constexpr const char* list_name = "multires_slots_5";

using Slots = std::set<Slot*>;

/// The document's list. A child of it and found by name: of the ways to hang something on a QObject this is the one
/// that survives a failed allocation.
struct SlotList : QObject {
    ~SlotList() override {
        for (Slot* slot : slots_) slot->kept = {}, slot->all = nullptr;  // the document goes, and its meshes with it
    }
    Slots slots_;
};

bool is_slot(const vcg::PointerToAttribute& a) { return a._name == attribute_name && a._type == typeid(Slot); }

Slot* find_slot(const CMeshO& mesh) {
    const auto at = std::find_if(mesh.mesh_attr.begin(), mesh.mesh_attr.end(), is_slot);
    return at == mesh.mesh_attr.end() ? nullptr : static_cast<Slot*>(at->_handle->DataBegin());
}

Slots* find_slots(const MeshDocument& document) {
    for (QObject* child : document.children())
        if (child->objectName() == QLatin1String(list_name)) return &static_cast<SlotList*>(child)->slots_;
    return nullptr;
}

Slots& make_slots(MeshDocument& document) {
    if (Slots* list = find_slots(document)) return *list;
    auto list = std::make_unique<SlotList>();
    list->setObjectName(list_name);
    list->setParent(&document);
    return list.release()->slots_;
}

}  // namespace

Kept kept(const CMeshO& mesh) {
    const Slot* slot = find_slot(mesh);
    return slot ? slot->kept : Kept();
}

Borrowed::Borrowed(CMeshO& mesh, Session& to) : mesh_(mesh), session_(to) {
    Slot* slot = find_slot(mesh);
    if (!slot) return;
    to.pyramids = std::exchange(slot->kept.pyramids, {});
    to.intermediates = std::exchange(slot->kept.intermediates, {});
}

Borrowed::~Borrowed() {
    Slot* slot = find_slot(mesh_);
    if (!slot) return;
    slot->kept.pyramids = std::move(session_.pyramids);
    slot->kept.intermediates = std::move(session_.intermediates);
}

void release_deleted(const MeshDocument& document) noexcept {
    Slots* const list = find_slots(document);
    if (!list) return;
    const auto alive = [&](const Slot* slot) {
        bool found = false;
        for_each_mesh(document, [&](const MeshModel& model) { found = found || find_slot(model.cm) == slot; });
        return found;
    };
    for (auto at = list->begin(); at != list->end();) {
        Slot* const slot = *at;
        const auto next = std::next(at);
        if (!alive(slot)) {
            list->erase(at);
            slot->kept = {}, slot->all = nullptr;
        }
        at = next;
    }
}

Keeper::Keeper(MeshDocument& document, CMeshO& mesh) : mesh_(mesh), slot_(find_slot(mesh)) {
    if (slot_) return;
    Slots& list = make_slots(document);
    vcg::PointerToAttribute name;
    name._name = attribute_name;
    other_ = mesh.mesh_attr.extract(name);
    try {
        slot_ = &vcg::tri::Allocator<CMeshO>::AddPerMeshAttribute<Slot>(mesh, attribute_name)();
        made_ = true;
        list.insert(slot_);
        slot_->all = &list;
    } catch (...) {
        take_back();
        throw;
    }
}

Keeper::~Keeper() { take_back(); }

void Keeper::take_back() noexcept {
    if (made_) {
        const auto at = std::find_if(mesh_.mesh_attr.begin(), mesh_.mesh_attr.end(), is_slot);
        delete at->_handle;
        mesh_.mesh_attr.erase(at);
    }
    if (other_) mesh_.mesh_attr.insert(std::move(other_));
}

void Keeper::keep(Kept what) noexcept {
    slot_->kept = std::move(what);
    made_ = false;
    if (!other_) return;
    delete other_.value()._handle;
    other_ = {};
}

}  // namespace multires::host
