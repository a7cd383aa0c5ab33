#pragma once

#include "host/api.h"

#include <QObject>

#include <streambuf>

/// The plugin class of MeshLab 2022.02 and later: a table of filters seen through FilterPlugin. host_2020.h is its
/// twin.
namespace multires::host {

class Host : public QObject, public FilterPlugin {
public:
    explicit Host(const plugin::Plugin& table);

    QString pluginName() const override;
    QString vendor() const override;
    QString filterName(ActionIDType id) const override;
    QString pythonFilterName(ActionIDType id) const override;
    QString filterInfo(ActionIDType id) const override;
    FilterClass getClass(const QAction* action) const override;
    FilterArity filterArity(const QAction* action) const override;
    int getPreConditions(const QAction* action) const override;
    int postCondition(const QAction* action) const override;
    RichParameterList initParameterList(const QAction* action, const MeshDocument& document) override;
    std::map<std::string, QVariant> applyFilter(const QAction* action, const RichParameterList& list,
                                                MeshDocument& document, unsigned int& changed,
                                                vcg::CallBackPos* callback) override;

private:
    void end_as_pymeshlab_should();

    const plugin::Plugin& table_;
    std::streambuf* output_;  ///< of std::cout and std::cerr, before the host runs a filter
    std::streambuf* errors_;
};

}  // namespace multires::host
