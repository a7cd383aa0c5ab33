#include "host/io.h"

#include "base/progress.h"
#include "vcg/conversion.h"

#include <wrap/io_trimesh/io_mask.h>

#include <QFile>
#include <QSaveFile>

#include <algorithm>

namespace multires::host::io {
namespace {

using vcg::tri::io::Mask;

bool has(const std::vector<Attribute>& attributes, AttributeKind kind) {
    return std::any_of(attributes.begin(), attributes.end(), [&](const Attribute& a) { return a.kind == kind; });
}

int mask_of(const Layer& layer) {
    int mask = Mask::IOM_VERTCOORD | Mask::IOM_FACEINDEX;
    if (has(layer.attributes, AttributeKind::color)) mask |= Mask::IOM_VERTCOLOR;
    if (has(layer.attributes, AttributeKind::quality)) mask |= Mask::IOM_VERTQUALITY;
    if (has(layer.attributes, AttributeKind::texcoord)) mask |= Mask::IOM_VERTTEXCOORD;
    if (!layer.wedges.empty()) mask |= Mask::IOM_WEDGTEXCOORD;
    return mask;
}

void fill(MeshModel& model, const Layer& layer) {
    CMeshO& mesh = model.cm;
    enable_for_file(model, mask_of(layer));
    make_custom_attributes(mesh, layer.attributes);
    vcg::tri::Allocator<CMeshO>::AddVertices(mesh, layer.mesh.positions.size());
    vcg::tri::Allocator<CMeshO>::AddFaces(mesh, layer.mesh.faces.size());
    for (std::size_t v = 0; v < layer.mesh.positions.size(); ++v)
        for (int k = 0; k < 3; ++k) mesh.vert[v].P()[k] = static_cast<Scalarm>(layer.mesh.positions[v][k]);
    for (std::size_t f = 0; f < layer.mesh.faces.size(); ++f)
        for (int k = 0; k < 3; ++k) mesh.face[f].V(k) = &mesh.vert[layer.mesh.faces[f][k]];
    LayerChanges changes;
    changes.attributes = &layer.attributes;
    if (!layer.wedges.empty()) changes.wedges = &layer.wedges;
    write(mesh, to_layer(mesh), changes);
}

}  // namespace

void add_open_parameters(RichParameterList& list) {
    list.addParam(
        RichInt("max_vertices", 0, "Vertices at most", "Reading stops as soon as there are so many; 0: no limit."));
    list.addParam(RichInt("max_bytes", 0, "Bytes at most", "No more of the file is read than this; 0: all."));
    list.addParam(RichFloat("max_error", 0, "Error small enough",
                            "Reading stops as soon as the RMS distance from the whole mesh is estimated to be at most "
                            "this, mesh units; 0: no limit."));
}

void add_save_parameters(RichParameterList& list) {
    list.addParam(RichInt("bits", 12, "Bits of a coordinate", "Over the longest side of the box, 1 to 24."));
    list.addParam(RichBool("exact", false, "Exact", "Coordinates come back bit for bit once the whole file is read."));
    list.addParam(RichBool("keep_order", false, "Keep the order",
                           "Vertices and faces come back in their order, once the whole file is read."));
}

int open(const QString& name, MeshModel& model, const RichParameterList& list) {
    QFile file(name);
    require(file.open(QIODevice::ReadOnly), "the file cannot be opened");
    stream::Limits limits;
    if (list.getInt("max_vertices") > 0) limits.vertices = list.getInt("max_vertices");
    if (list.getFloat("max_error") > 0) limits.error = list.getFloat("max_error");
    const int most = list.getInt("max_bytes");
    stream::Decoder decoder(limits);
    qint64 left = most > 0 ? std::min<qint64>(most, file.size()) : file.size();
    while (left > 0 && !decoder.satisfied()) {
        const QByteArray bytes = file.read(std::min<qint64>(left, 1 << 16));
        if (bytes.isEmpty()) break;
        decoder.feed(reinterpret_cast<const std::uint8_t*>(bytes.constData()), static_cast<std::size_t>(bytes.size()));
        left -= bytes.size();
    }
    require(decoder.started(), "there is no mesh in so few bytes");
    const Layer layer = decoder.layer();
    fill(model, layer);
    return mask_of(layer);
}

void save(const QString& name, const MeshModel& model, int mask, const RichParameterList& list,
          vcg::CallBackPos* callback) {
    AttributeRequest request;
    // Hosts ask for all that the format can hold, whether the mesh has it or not.
    const auto wanted = [&](int bit, int element) { return (mask & bit) != 0 && model.hasDataMask(element); };
    request.color = wanted(Mask::IOM_VERTCOLOR, MeshModel::MM_VERTCOLOR);
    request.quality = wanted(Mask::IOM_VERTQUALITY, MeshModel::MM_VERTQUALITY);
    request.texcoord = wanted(Mask::IOM_VERTTEXCOORD, MeshModel::MM_VERTTEXCOORD);
    request.wedges = wanted(Mask::IOM_WEDGTEXCOORD, MeshModel::MM_WEDGTEXCOORD);
    request.custom = custom_attribute_names(model.cm);
    stream::EncodeOptions options;
    options.bits = list.getInt("bits");
    options.exact = list.getBool("exact");
    options.keep_order = list.getBool("keep_order");
    const stream::Bytes bytes = stream::encode(to_layer(model.cm, request).layer, options, [&](double done) {
        if (callback && !callback(static_cast<int>(100 * done), "Saving")) throw Cancelled();
    });
    QSaveFile file(name);  // what was there stays until the new file is whole
    require(file.open(QIODevice::WriteOnly), "the file cannot be written");
    const auto size = static_cast<qint64>(bytes.size());
    require(file.write(reinterpret_cast<const char*>(bytes.data()), size) == size && file.commit(),
            "the file cannot be written");
}

int capability() {
    return Mask::IOM_VERTCOORD | Mask::IOM_FACEINDEX | Mask::IOM_VERTCOLOR | Mask::IOM_VERTQUALITY |
           Mask::IOM_VERTTEXCOORD | Mask::IOM_WEDGTEXCOORD;
}

}  // namespace multires::host::io
