#pragma once

#include "host/io.h"

#include <QObject>

/// The file format .mrm as a plugin of MeshLab 2020.09. io_host_2022.h is its twin.
namespace multires::host {

class IoHost : public QObject, public MeshIOInterface {
public:
    QString pluginName() const override { return "IoMultires"; }
    QList<Format> importFormats() const override { return formats(); }
    QList<Format> exportFormats() const override { return formats(); }
    void GetExportMaskCapability(QString& /*format*/, int& capability, int& defaults) const override {
        capability = defaults = io::capability();
    }
    void initPreOpenParameter(const QString& format, const QString& file, RichParameterList& list) override;
    void initSaveParameter(const QString& format, MeshModel& model, RichParameterList& list) override;
    bool open(const QString& format, const QString& file, MeshModel& model, int& mask, const RichParameterList& list,
              vcg::CallBackPos* callback, QWidget* parent) override;
    bool save(const QString& format, const QString& file, MeshModel& model, const int mask,
              const RichParameterList& list, vcg::CallBackPos* callback, QWidget* parent) override;

private:
    static QList<Format> formats() { return {Format(io::description, io::extension)}; }
};

}  // namespace multires::host
