#include "host/document.h"

namespace multires::host {
namespace {

/// MeshElement bits that mean data; the others are adjacencies and marks, which are computed where needed.
constexpr int data_elements = MeshModel::MM_VERTCOLOR | MeshModel::MM_VERTQUALITY | MeshModel::MM_VERTCURV |
                              MeshModel::MM_VERTCURVDIR | MeshModel::MM_VERTRADIUS | MeshModel::MM_VERTTEXCOORD |
                              MeshModel::MM_FACECOLOR | MeshModel::MM_FACEQUALITY | MeshModel::MM_FACECURVDIR |
                              MeshModel::MM_WEDGTEXCOORD | MeshModel::MM_WEDGNORMAL | MeshModel::MM_WEDGCOLOR |
                              MeshModel::MM_CAMERA | MeshModel::MM_TRANSFMATRIX | MeshModel::MM_COLOR;

/// A layer being made: deleted again unless it is finished.
class NewLayer {
public:
    NewLayer(MeshDocument& document, const MeshModel& source, const VcgLayer& flat, const DerivedMesh& derived)
        : document_(document), current_(source.id()),
          model_(document.addNewMesh("", QString::fromStdString(derived.name), false)) {
        try {
            fill(source, flat, derived);
        } catch (...) {
            take_back();
            throw;
        }
    }
    ~NewLayer() {
        if (model_) take_back();
    }
    NewLayer(const NewLayer&) = delete;
    NewLayer& operator=(const NewLayer&) = delete;

    void finish() {
        document_.setCurrentMesh(model_->id());
        model_ = nullptr;
    }
    const std::vector<std::string>& left_out() const { return left_out_; }

private:
    void take_back() {
        delete_layer(document_, *model_);
        document_.setCurrentMesh(current_);  // hosts move on to another layer when one is deleted
    }

    void fill(const MeshModel& source, const VcgLayer& flat, const DerivedMesh& derived) {
        left_out_ = build_derived(model_->cm, source.cm, flat, derived);
        model_->updateDataMask(source.dataMask() & data_elements);
        model_->cm.Tr = source.cm.Tr;
        model_->cm.shot = source.cm.shot;
        copy_texture_images(*model_, source);
        update_box_and_normals(*model_);
    }

    MeshDocument& document_;
    int current_;  // the source's: filters work on the current layer
    MeshModel* model_;
    std::vector<std::string> left_out_;
};

/// Switches data on that the result needs and the mesh lacks: off again unless it is finished.
class NewElements {
public:
    NewElements(MeshModel& model, const Result& result) : model_(model) {
        int needed = 0;
        if (result.quality) needed |= MeshModel::MM_VERTQUALITY;
        for (const Attribute& a : result.attributes) {
            if (a.kind == AttributeKind::color) needed |= MeshModel::MM_VERTCOLOR;
            if (a.kind == AttributeKind::quality) needed |= MeshModel::MM_VERTQUALITY;
            if (a.kind == AttributeKind::texcoord) needed |= MeshModel::MM_VERTTEXCOORD;
        }
        if (result.wedges) needed |= MeshModel::MM_WEDGTEXCOORD;
        added_ = needed & ~model.dataMask();
        customs_ = make_custom_attributes(model.cm, result.attributes);
        try {
            model.updateDataMask(added_);
            if (added_ & MeshModel::MM_VERTTEXCOORD)  // which vcg leaves without any value
                for (auto& v : model.cm.vert) v.T() = {0, 0};
        } catch (...) {
            take_back();
            throw;
        }
    }
    ~NewElements() { take_back(); }
    NewElements(const NewElements&) = delete;
    NewElements& operator=(const NewElements&) = delete;

    void finish() {
        added_ = 0;
        customs_.clear();
    }

private:
    /// Not by clearDataMask alone: vcg says that a component is there before it has memory for it, and the mask does
    /// not know of it yet.
    void take_back() {
        if (added_ & MeshModel::MM_VERTTEXCOORD) model_.cm.vert.DisableTexCoord();
        if (added_ & MeshModel::MM_WEDGTEXCOORD) model_.cm.face.DisableWedgeTexCoord();
        model_.clearDataMask(added_);
        remove_custom_attributes(model_.cm, customs_);
    }

    MeshModel& model_;
    int added_ = 0;
    std::vector<std::string> customs_;  ///< names of attributes that were made
};

LayerChanges changes_of(const Result& result) {
    LayerChanges changes;
    changes.positions = result.positions ? &*result.positions : nullptr;
    changes.quality = result.quality ? &*result.quality : nullptr;
    changes.attributes = &result.attributes;
    changes.wedges = result.wedges ? &*result.wedges : nullptr;
    changes.selected_vertex = result.selected_vertex ? &*result.selected_vertex : nullptr;
    changes.selected_edges = result.selected_edges ? &*result.selected_edges : nullptr;
    return changes;
}

VcgLayer placed_layer(const MeshModel& model, const AttributeRequest& request) {
    VcgLayer flat = to_layer(model.cm, request);
    for (int i = 0; i < 4; ++i)
        for (int j = 0; j < 4; ++j) flat.layer.to_world(i, j) = model.cm.Tr[i][j];
    return flat;
}

AttributeRequest requested_by(const plugin::Filter& filter, const MeshModel& model) {
    AttributeRequest request;
    request.color = filter.reads & plugin::vertex_color && model.hasDataMask(MeshModel::MM_VERTCOLOR);
    request.quality = filter.reads & plugin::vertex_quality && model.hasDataMask(MeshModel::MM_VERTQUALITY);
    request.texcoord = filter.reads & plugin::vertex_texcoord && model.hasDataMask(MeshModel::MM_VERTTEXCOORD);
    request.wedges = filter.reads & plugin::wedge_texcoord && model.hasDataMask(MeshModel::MM_WEDGTEXCOORD);
    if (filter.reads & plugin::custom_attributes) request.custom = custom_attribute_names(model.cm);
    return request;
}

}  // namespace

VcgLayer read_layer(const plugin::Filter& filter, const MeshModel& model) {
    return placed_layer(model, requested_by(filter, model));
}

VcgLayer read_other_layer(const plugin::Filter& filter, const MeshModel& model) {
    AttributeRequest request = requested_by(filter, model);
    if (request.custom.empty())
        for (const std::string& name : custom_attribute_names(model.cm))
            if (name == source_vertex_name) request.custom.push_back(name);
    return placed_layer(model, request);
}

struct PendingResult::Parts {
    Parts(MeshDocument& document, MeshModel& to, const VcgLayer& from, Result what, Kept to_keep)
        : model(to), flat(from), result(std::move(what)), kept(std::move(to_keep)),
          layer(result.layer ? std::make_unique<NewLayer>(document, to, from, *result.layer) : nullptr),
          elements(to, result) {
        check_changes(model.cm, flat, changes_of(result));
        if (layer)
            for (const std::string& name : layer->left_out())
                result.report.say("Custom attribute \"" + name +
                                  "\" has a type that cannot be copied to the new layer.");
        if (!kept.empty()) keeper.emplace(document, model.cm);
    }

    MeshModel& model;
    const VcgLayer& flat;
    Result result;
    Kept kept;
    std::unique_ptr<NewLayer> layer;
    NewElements elements;
    std::optional<Keeper> keeper;
};

PendingResult::PendingResult(MeshDocument& document, MeshModel& model, const VcgLayer& flat, Result result,
                             Kept to_keep)
    : parts_(std::make_unique<Parts>(document, model, flat, std::move(result), std::move(to_keep))) {}

PendingResult::~PendingResult() = default;

const Report& PendingResult::report() const { return parts_->result.report; }

void PendingResult::commit() noexcept {
    write(parts_->model.cm, parts_->flat, changes_of(parts_->result));
    if (parts_->keeper) parts_->keeper->keep(std::move(parts_->kept));
    if (parts_->result.positions) update_box_and_normals(parts_->model);
    parts_->elements.finish();
    if (parts_->layer) parts_->layer->finish();
}

}  // namespace multires::host
