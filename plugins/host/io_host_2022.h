#pragma once

#include "host/io.h"

#include <common/plugins/interfaces/io_plugin.h>

#include <QObject>

/// The file format .mrm as a plugin of MeshLab 2022.02 and later. io_host_2020.h is its twin.
namespace multires::host {

class IoHost : public QObject, public IOPlugin {
public:
    QString pluginName() const override { return "IoMultires"; }
    QString vendor() const override { return "meshlab-multires"; }
    std::list<FileFormat> importFormats() const override { return formats(); }
    std::list<FileFormat> exportFormats() const override { return formats(); }
    void exportMaskCapability(const QString& /*format*/, int& capability, int& defaults) const override {
        capability = defaults = io::capability();
    }
    RichParameterList initPreOpenParameter(const QString& format) const override;
    RichParameterList initSaveParameter(const QString& format, const MeshModel& model) const override;
    void open(const QString& format, const QString& file, MeshModel& model, int& mask, const RichParameterList& list,
              vcg::CallBackPos* callback) override;
    void save(const QString& format, const QString& file, MeshModel& model, const int mask,
              const RichParameterList& list, vcg::CallBackPos* callback) override;

private:
    static std::list<FileFormat> formats() { return {FileFormat(io::description, QString(io::extension))}; }
};

}  // namespace multires::host
