// Writes the models and start states of the box demos: make_models DIR, DIR being the demos/ folder.
#include "models.h"

#include <kolize/mass_properties.h>
#include <kolize/mesh_io.h>

#include <exception>
#include <filesystem>
#include <fstream>
#include <iostream>

using namespace kolize;
using namespace kolize::models;

namespace {

void write_text(const std::filesystem::path& file, const std::string& text) {
    if (!(std::ofstream(file, std::ios::binary) << text).flush())
        throw Error(SourceLocation{file.string()}, "this file cannot be written");
}

void write_box_cubes(const std::filesystem::path& folder) {
    std::filesystem::create_directories(folder);
    StateWriter states(2.3, 0.2, 4, 4, 27);
    write_text(folder / "states.csv", states.table(27, Vec3::Zero()));
}

void write_box_objects(const std::filesystem::path& folder) {
    std::filesystem::create_directories(folder / "models");
    std::filesystem::create_directories(folder / "states");
    StateWriter states(2.4, 0.2, 4, 4, 8);
    int number = 0;
    for (const Model& model : object_models()) {
        const TriangleSoup soup = model.make();
        write_mesh(soup, folder / "models" / (std::string(model.name) + ".obj"));
        const int count = number++ % 2 ? 3 : 2;
        write_text(folder / "states" / (std::string(model.name) + ".csv"),
                   states.table(count, mass_properties(soup).center_of_mass));
    }
}

void write_box_fighter(const std::filesystem::path& folder) {
    std::filesystem::create_directories(folder);
    write_mesh(fighter(), folder / "fighter.obj");
}

}  // namespace

int main(int argc, char** argv) {
    if (argc != 2) {
        std::cerr << "usage: make_models DIR\nWrites the models and start states of the box demos below DIR.\n";
        return 2;
    }
    try {
        const std::filesystem::path folder = argv[1];
        write_box_cubes(folder / "box_cubes");
        write_box_objects(folder / "box_objects");
        write_box_fighter(folder / "box_fighter");
    } catch (const std::exception& error) {
        std::cerr << error.what() << '\n';
        return 2;
    }
}
