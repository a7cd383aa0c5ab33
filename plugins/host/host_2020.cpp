#include "host/host_2020.h"

#include "host/apply.h"
#include "host/fold_2020.h"
#include "host/stay_loaded.h"

#include <QAction>

namespace multires::host {

Host::Host(const plugin::Plugin& table) : table_(table) {
    stay_loaded();
    for (std::size_t id = 0; id < table.filters.size(); ++id) {
        typeList << static_cast<FilterIDType>(id);
        actionList << new QAction(QString::fromStdString(table.filters[id].name), this);
    }
}

QString Host::pluginName() const { return QString::fromStdString(table_.name); }
QString Host::filterName(FilterIDType id) const { return QString::fromStdString(table_.filters.at(id).name); }
QString Host::filterInfo(FilterIDType id) const { return QString::fromStdString(table_.filters.at(id).info); }

Host::FilterClass Host::getClass(QAction* action) { return menu_class(row(table_, action)); }
Host::FILTER_ARITY Host::filterArity(QAction* /*action*/) const { return SINGLE_MESH; }
int Host::getPreConditions(QAction* action) const { return precondition(row(table_, action)); }
int Host::postCondition(QAction* action) const { return postcondition(row(table_, action)); }

void Host::initParameterSet(QAction* action, MeshDocument& document, RichParameterList& list) {
    list = parameters(row(table_, action), document);
    fold_advanced(row(table_, action));
}

bool Host::applyFilter(QAction* action, MeshDocument& document, const RichParameterList& list,
                       vcg::CallBackPos* callback) {
    std::string message;
    try {
        std::vector<std::string> lines;
        apply(row(table_, action), list, document, callback, [&](const Report& report) { lines = log_lines(report); });
        tell(lines, [&](const std::string& line) { Log(GLLogStream::FILTER, line); });
        return true;
    } catch (...) {
        message = describe_exception();
    }
    // The GUI shows errorMessage, meshlabserver only the log.
    errorMessage = QString::fromStdString(message);
    Log(GLLogStream::WARNING, message);
    return false;
}

}  // namespace multires::host
