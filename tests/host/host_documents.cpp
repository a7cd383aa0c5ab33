#include "host_documents.h"

#include "random.h"
#include "shapes.h"

#include <QAction>
#include <QDir>
#include <QPluginLoader>

#include <ostream>
#include <stdexcept>

namespace multires::host_tests {
namespace {

/// Of the plugins that are loaded. Not freed when the process ends: plugins stay to the end, as in MeshLab.
std::vector<QPluginLoader*>& loaders() {
    static auto* all = new std::vector<QPluginLoader*>;
    return *all;
}

std::vector<Action> load() {
    std::vector<Action> all;
    const QDir folder(MULTIRES_PLUGINS);
    for (const QString& file : folder.entryList({"*filter_multires*.so"}, QDir::Files, QDir::Name)) {
        auto* loader = new QPluginLoader(folder.filePath(file));
        loaders().push_back(loader);
        auto* plugin = qobject_cast<FilterPlugin*>(loader->instance());
        if (!plugin) throw std::runtime_error(loader->errorString().toStdString());
        for (QAction* action : plugin->actions())
            all.push_back({plugin, action, plugin->pythonFilterName(action).toStdString()});
    }
    return all;
}

}  // namespace

std::ostream& operator<<(std::ostream& out, const Action& a) { return out << a.name; }

const std::vector<Action>& actions() {
    static const std::vector<Action> all = load();
    return all;
}

void unload() {
    for (QPluginLoader* loader : loaders()) {
        if (!loader->unload()) throw std::runtime_error(loader->errorString().toStdString());
        delete loader;
    }
    loaders().clear();
}

const Action& action_named(const std::string& name) {
    for (const Action& a : actions())
        if (a.name == name) return a;
    throw std::logic_error("no filter " + name);
}

RichParameterList parameters_of(const Action& action, const MeshDocument& document) {
    return action.plugin->initParameterList(action.action, document);
}

RichParameterList small_parameters_of(const Action& action, const MeshDocument& document) {
    RichParameterList list = parameters_of(action, document);
    if (list.hasParameter("base_vertices")) list.setValue("base_vertices", IntValue(8));
    if (list.hasParameter("level")) list.setValue("level", IntValue(1));
    if (list.hasParameter("oracle")) list.setValue("oracle", IntValue(0));
    return list;
}

MeshModel& add(MeshDocument& document, const Mesh& mesh, const char* label) {
    MeshModel& model = *document.addNewMesh("", label, true);
    using Allocator = vcg::tri::Allocator<CMeshO>;
    CMeshO& m = model.cm;
    if (!mesh.positions.empty()) Allocator::AddVertices(m, mesh.positions.size());
    for (std::size_t i = 0; i < mesh.positions.size(); ++i)
        for (int k = 0; k < 3; ++k) m.vert[i].P()[k] = static_cast<Scalarm>(mesh.positions[i][k]);
    if (!mesh.faces.empty()) Allocator::AddFaces(m, mesh.faces.size());
    for (std::size_t f = 0; f < mesh.faces.size(); ++f)
        for (int k = 0; k < 3; ++k) m.face[f].V(k) = &m.vert[mesh.faces[f][k]];
    model.updateBoxAndNormals();
    return model;
}

void enrich(MeshModel& model) {
    CMeshO& m = model.cm;
    using Allocator = vcg::tri::Allocator<CMeshO>;
    model.updateDataMask(MeshModel::MM_VERTQUALITY | MeshModel::MM_VERTCOLOR | MeshModel::MM_VERTTEXCOORD |
                         MeshModel::MM_WEDGTEXCOORD | MeshModel::MM_FACECOLOR | MeshModel::MM_FACEQUALITY |
                         MeshModel::MM_VERTRADIUS);
    shapes::Random random(7);
    auto heat = Allocator::GetPerVertexAttribute<Scalarm>(m, "heat");
    auto flow = Allocator::GetPerVertexAttribute<Point3m>(m, "flow");
    for (auto& v : m.vert) {
        const auto number = [&] { return static_cast<Scalarm>(random.uniform()); };
        v.Q() = number();
        v.C() = vcg::Color4b(random.bits() % 256, random.bits() % 256, random.bits() % 256, 255);
        v.T().U() = static_cast<float>(random.uniform()), v.T().V() = static_cast<float>(random.uniform());
        v.T().N() = 0;
        v.R() = number();
        heat[v] = number();
        flow[v] = Point3m(number(), number(), number());
    }
    for (auto& f : m.face) {
        f.Q() = static_cast<Scalarm>(random.uniform());
        for (int k = 0; k < 3; ++k) {
            const auto& p = f.cV(k)->cP();
            f.WT(k).U() = static_cast<float>(p[0]), f.WT(k).V() = static_cast<float>(p[1]);
            f.WT(k).N() = 0;
        }
    }
}

void fill(MeshDocument& document, const Action& action, Content content) {
    const bool grid = action.name.find("multires_grid") != std::string::npos, large = content == Content::large;
    Mesh mesh = grid    ? shapes::grid_terrain(large ? shapes::GridShape{163, 163} : shapes::GridShape{6, 7})
                : large ? shapes::scan(26000)
                        : shapes::irregular_sphere(42, {0.3, 0.3, 5});
    mesh.faces.resize(mesh.faces.size() - 3);
    mesh.positions.push_back({0, 3, 0});
    Mesh edited = mesh;  // what filters of two layers take: Follow Edited Layer a copy of the layer itself
    if (grid) edited.faces.erase(edited.faces.begin() + 7), edited.positions.pop_back();  // as it is deleted below
    for (Vec3& p : edited.positions) p.x() += 0.01 * p.y() * p.y();
    MeshModel& another = add(document, edited, "another");
    const bool near =  // it must be, or finding nearest points takes minutes
        action.name == "transfer_coord_multires_detail" ||
        (large && action.name == "apply_coord_multires_transfer_edit");
    if (near) another.cm.Tr.SetTranslate(1, 2, 3.01);
    MeshModel& model = add(document, mesh, "mesh");
    if (content != Content::bare) enrich(model);
    CMeshO& m = model.cm;
    vcg::tri::Allocator<CMeshO>::DeleteFace(m, m.face[7]);
    vcg::tri::Allocator<CMeshO>::DeleteVertex(m, m.vert.back());
    for (std::size_t i = 0; i < 20; ++i) m.vert[i].SetS();
    for (std::size_t f = 0; f < 10; ++f) m.face[f].SetS();
    for (std::size_t f = 0; f < m.face.size(); f += 2) m.face[f].SetF(0);
    m.Tr.SetTranslate(1, 2, 3);
}

}  // namespace multires::host_tests
