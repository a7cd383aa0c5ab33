#include "host/io_host_2020.h"

#include <exception>

namespace multires::host {

void IoHost::initPreOpenParameter(const QString& /*format*/, const QString& /*file*/, RichParameterList& list) {
    io::add_open_parameters(list);
}

void IoHost::initSaveParameter(const QString& /*format*/, MeshModel& /*model*/, RichParameterList& list) {
    io::add_save_parameters(list);
}

bool IoHost::open(const QString& /*format*/, const QString& file, MeshModel& model, int& mask,
                  const RichParameterList& list, vcg::CallBackPos* /*callback*/, QWidget* /*parent*/) {
    try {
        // meshlabserver asks for no parameters: then all is read.
        RichParameterList all;
        io::add_open_parameters(all);
        mask = io::open(file, model, list.hasParameter("max_vertices") ? list : all);
        return true;
    } catch (const std::exception& e) {
        model.Clear();
        errorMessage = file + ": " + e.what();
        return false;
    }
}

bool IoHost::save(const QString& /*format*/, const QString& file, MeshModel& model, const int mask,
                  const RichParameterList& list, vcg::CallBackPos* callback, QWidget* /*parent*/) {
    try {
        RichParameterList defaults;
        io::add_save_parameters(defaults);
        io::save(file, model, mask, list.hasParameter("bits") ? list : defaults, callback);
        return true;
    } catch (const std::exception& e) {
        errorMessage = file + ": " + e.what();
        return false;
    }
}

}  // namespace multires::host
