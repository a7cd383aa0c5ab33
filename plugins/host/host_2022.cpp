#include "host/host_2022.h"

#include "host/apply.h"

#include <QAction>

namespace multires::host {
namespace {

QVariant variant(const Report::Value& value) {
    if (const auto* list = std::get_if<std::vector<double>>(&value))
        return QVariant::fromValue<Eigen::VectorXd>(Eigen::Map<const Eigen::VectorXd>(list->data(), list->size()));
    if (const auto* flag = std::get_if<bool>(&value)) return *flag;
    if (const auto* number = std::get_if<int>(&value)) return *number;
    return std::get<double>(value);
}

/// pymeshlab gives None for an empty map, so there is always something in it.
std::map<std::string, QVariant> values(const Report& report) {
    std::map<std::string, QVariant> map;
    for (const Report::Entry& entry : report.entries()) map[entry.key] = variant(entry.value);
    if (map.empty()) map["success"] = true;
    return map;
}

}  // namespace

Host::Host(const plugin::Plugin& table) : table_(table) {
    for (std::size_t id = 0; id < table.filters.size(); ++id) {
        typeList.push_back(static_cast<ActionIDType>(id));
        actionList.push_back(new QAction(QString::fromStdString(table.filters[id].name), this));
    }
}

QString Host::pluginName() const { return QString::fromStdString(table_.name); }
QString Host::vendor() const { return "meshlab-multires"; }
QString Host::filterName(ActionIDType id) const { return QString::fromStdString(table_.filters.at(id).name); }
QString Host::filterInfo(ActionIDType id) const { return QString::fromStdString(table_.filters.at(id).info); }
QString Host::pythonFilterName(ActionIDType id) const {
    return QString::fromStdString(table_.filters.at(id).python_name);
}

Host::FilterClass Host::getClass(const QAction* action) const { return menu_class(row(table_, action)); }
Host::FilterArity Host::filterArity(const QAction* /*action*/) const { return SINGLE_MESH; }
int Host::getPreConditions(const QAction* action) const { return precondition(row(table_, action)); }
int Host::postCondition(const QAction* action) const { return postcondition(row(table_, action)); }

RichParameterList Host::initParameterList(const QAction* action, const MeshDocument& document) {
    return parameters(row(table_, action), document);
}

std::map<std::string, QVariant> Host::applyFilter(const QAction* action, const RichParameterList& list,
                                                  MeshDocument& document, unsigned int& changed,
                                                  vcg::CallBackPos* callback) {
    std::string message;
    try {
        const plugin::Filter& filter = row(table_, action);
        std::vector<std::string> lines;
        std::map<std::string, QVariant> returned;
        apply(filter, list, document, callback, [&](const Report& report) {
            lines = log_lines(report);
            returned = values(report);
        });
        changed = postcondition(filter);
        tell(lines, [&](const std::string& line) { log(GLLogStream::FILTER, line); });
        return returned;
    } catch (...) {
        message = describe_exception();
    }
    throw MLException(QString::fromStdString(message));
}

}  // namespace multires::host
