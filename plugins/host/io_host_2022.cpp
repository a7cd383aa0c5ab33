#include "host/io_host_2022.h"

#include <exception>

namespace multires::host {

RichParameterList IoHost::initPreOpenParameter(const QString& /*format*/) const {
    RichParameterList list;
    io::add_open_parameters(list);
    return list;
}

RichParameterList IoHost::initSaveParameter(const QString& /*format*/, const MeshModel& /*model*/) const {
    RichParameterList list;
    io::add_save_parameters(list);
    return list;
}

void IoHost::open(const QString& /*format*/, const QString& file, MeshModel& model, int& mask,
                  const RichParameterList& list, vcg::CallBackPos* /*callback*/) {
    try {
        mask = io::open(file, model, list);
    } catch (const std::exception& e) {
        model.clear();
        throw MLException(file + ": " + e.what());
    }
}

void IoHost::save(const QString& /*format*/, const QString& file, MeshModel& model, const int mask,
                  const RichParameterList& list, vcg::CallBackPos* callback) {
    try {
        io::save(file, model, mask, list, callback);
    } catch (const std::exception& e) {
        throw MLException(file + ": " + e.what());
    }
}

}  // namespace multires::host
