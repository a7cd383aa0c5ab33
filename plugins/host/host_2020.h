#pragma once

#include "host/api.h"

#include <QObject>

/// The plugin class of MeshLab 2020.09: a table of filters seen through MeshFilterInterface. host_2022.h is its twin.
namespace multires::host {

class Host : public QObject, public MeshFilterInterface {
public:
    explicit Host(const plugin::Plugin& table);

    QString pluginName() const override;
    QString filterName(FilterIDType id) const override;
    QString filterInfo(FilterIDType id) const override;
    FilterClass getClass(QAction* action) override;
    FILTER_ARITY filterArity(QAction* action) const override;
    int getPreConditions(QAction* action) const override;
    int postCondition(QAction* action) const override;
    void initParameterSet(QAction* action, MeshDocument& document, RichParameterList& list) override;
    bool applyFilter(QAction* action, MeshDocument& document, const RichParameterList& list,
                     vcg::CallBackPos* callback) override;

private:
    const plugin::Plugin& table_;
};

}  // namespace multires::host
