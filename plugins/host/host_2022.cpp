#include "host/host_2022.h"

#include "host/apply.h"
#include "host/stay_loaded.h"

#include <QAction>

#include <iostream>

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

Host::Host(const plugin::Plugin& table) : table_(table), output_(std::cout.rdbuf()), errors_(std::cerr.rdbuf()) {
    stay_loaded();
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
    output_ = std::cout.rdbuf(), errors_ = std::cerr.rdbuf();
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
    end_as_pymeshlab_should();
    throw MLException(QString::fromStdString(message));
}

/// Before a filter runs, pymeshlab 2025.7 gives it the document's log and sends C++'s streams elsewhere, to what
/// belongs to the document. It takes both back only if the filter succeeds, so that a failure leaves pointers to a
/// document that may be gone. MeshLab itself sets the log before each call and leaves the streams alone.
void Host::end_as_pymeshlab_should() {
    setLog(nullptr);
    std::cout.rdbuf(output_);
    std::cerr.rdbuf(errors_);
}

}  // namespace multires::host
