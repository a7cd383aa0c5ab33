// Writes the generated meshes as binary PLY files:  make_meshes OUTDIR [SCAN_VERTICES]
//                                                   make_meshes --stone SEED FILE
//
// One file per class of shapes::every_class(), nan.ply and infinity.ply, terrain.ply with its colours, texture
// coordinates and scalar, grid.ply with the same on a triangular grid, and, if a number is given, scan_<number>.ply of
// about that many vertices. Or an engraved stone with the depth of its letters as quality.

#include "shapes.h"

#include <cstring>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <limits>
#include <stdexcept>
#include <string>

namespace {

using namespace multires;

/// Bytes of one PLY file. Positions and scalars are doubles; all our machines are little endian.
class Ply {
public:
    explicit Ply(const Mesh& mesh, const shapes::Terrain* data = nullptr,
                 const std::vector<double>* quality = nullptr) {
        head_ = "ply\nformat binary_little_endian 1.0\nelement vertex " + std::to_string(mesh.positions.size()) +
                "\nproperty double x\nproperty double y\nproperty double z\n";
        if (data != nullptr) {
            head_ += "property uchar red\nproperty uchar green\nproperty uchar blue\nproperty uchar alpha\n"
                     "property float s\nproperty float t\nproperty double quality\n";
        }
        if (quality != nullptr) head_ += "property double quality\n";
        head_ += "element face " + std::to_string(mesh.faces.size()) +
                 "\nproperty list uchar int vertex_indices\nend_header\n";
        for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
            for (int k = 0; k < 3; ++k) put(mesh.positions[v][k]);
            if (quality != nullptr) put((*quality)[v]);
            if (data == nullptr) continue;
            for (int k = 0; k < 4; ++k) put(static_cast<unsigned char>(data->color[4 * v + k]));
            for (int k = 0; k < 2; ++k) put(static_cast<float>(data->texcoord[2 * v + k]));
            put(data->scalar[v]);
        }
        for (const Face& f : mesh.faces) {
            put(static_cast<unsigned char>(3));
            for (const Index v : f) put(v);
        }
    }

    void write(const std::filesystem::path& path) const {
        std::ofstream file(path, std::ios::binary);
        file << head_;
        file.write(bytes_.data(), static_cast<std::streamsize>(bytes_.size()));
        if (!file) throw std::runtime_error("cannot write " + path.string());
    }

private:
    template <class T>
    void put(T value) {
        char raw[sizeof(T)];
        std::memcpy(raw, &value, sizeof(T));
        bytes_.append(raw, sizeof(T));
    }

    std::string head_, bytes_;
};

void write_all(const std::filesystem::path& folder) {
    std::filesystem::create_directories(folder);
    for (const auto& [name, mesh] : shapes::every_class()) Ply(mesh).write(folder / (name + ".ply"));
    const shapes::Terrain terrain = shapes::terrain(64);
    Ply(terrain.mesh, &terrain).write(folder / "terrain.ply");
    const shapes::Terrain grid = shapes::regular_terrain(48);
    Ply(grid.mesh, &grid).write(folder / "grid.ply");
    Ply(shapes::not_finite(std::numeric_limits<double>::quiet_NaN())).write(folder / "nan.ply");
    Ply(shapes::not_finite(std::numeric_limits<double>::infinity())).write(folder / "infinity.ply");
}

}  // namespace

int main(int argc, char** argv) {
    const bool stone = argc == 4 && std::strcmp(argv[1], "--stone") == 0;
    if (!stone && (argc < 2 || argc > 3)) {
        std::cerr << "usage: make_meshes OUTDIR [SCAN_VERTICES] | --stone SEED FILE\n";
        return 2;
    }
    try {
        if (stone) {
            shapes::EngravedStoneOptions options;
            options.seed = std::stoull(argv[2]);
            const shapes::EngravedStone made = shapes::engraved_stone(options);
            Ply(made.mesh, nullptr, &made.cut).write(argv[3]);
            return 0;
        }
        const std::filesystem::path folder(argv[1]);
        write_all(folder);
        if (argc == 3) Ply(shapes::scan(std::stoi(argv[2]))).write(folder / ("scan_" + std::string(argv[2]) + ".ply"));
    } catch (const std::exception& error) {
        std::cerr << "make_meshes: " << error.what() << '\n';
        return 1;
    }
    return 0;
}
