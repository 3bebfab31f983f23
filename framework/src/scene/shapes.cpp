#include <kolize/mesh_io.h>

#include "parts.h"

#include <stdexcept>
#include <tuple>

namespace kolize::config {
namespace {

const std::vector<std::string> shape_kinds = {"sphere", "box", "half_space", "capsule", "hull", "mesh"};

// The name, which also goes into the reader's title: shape 'ball'.
std::string read_name(TableReader& reader, const std::string& what) {
    reader.require("name");
    const std::string name = reader.text("name", "");
    reader.set_title(what + " '" + name + "'");
    return name;
}

Shape read_sphere(TableReader& reader, const std::string& name) {
    reader.require("radius");
    return make_sphere(name, reader.number("radius", 0, positive));
}

Shape read_box(TableReader& reader, const std::string& name) {
    reader.require("half_extents");
    const Vec3 half_extents = reader.vector("half_extents", Vec3::Zero());
    if (!(half_extents.minCoeff() > 0)) reader.refuse("half_extents", "must be greater than 0 on every axis");
    return make_box(name, half_extents);
}

Shape read_half_space(TableReader& reader, const std::string& name) {
    reader.require("normal");
    const Vec3 normal = reader.vector("normal", Vec3::Zero());
    if (!std::isnormal(normal.squaredNorm())) reader.refuse("normal", "must have a length that is not 0");
    return make_half_space(name, normal.normalized(), reader.number("offset", 0));
}

// In a word; MeshDefects::first has the rest, so the word has to fit the first defect.
std::string main_defect(const MeshDefects& defects) {
    if (defects.empty) return "is empty";
    if (defects.degenerate_triangles) return "is degenerate";
    if (defects.inverted) return "is inside out";
    const bool open = defects.open_edges, branched = defects.non_manifold_edges, mixed = defects.misoriented_edges;
    if (open + branched + mixed > 1) return "is not the surface of a solid";
    return open ? "is open" : branched ? "is not two-manifold" : "is not oriented";
}

// Meshes are read and prepared once, whatever the number of shapes that use them.
class MeshCache {
public:
    explicit MeshCache(std::vector<std::string>& warnings) : warnings_(warnings) {}

    Shape read(TableReader& reader, const std::string& name) {
        const std::filesystem::path file = reader.path("file");
        const double scale = reader.number("scale", 1, positive);
        const bool open = reader.boolean("open", false);
        const auto key = std::tuple(std::filesystem::weakly_canonical(file), scale, open);
        const auto known = shapes_.find(key);
        Shape shape = known != shapes_.end() ? known->second : build(reader, file, scale, open);
        shapes_.emplace(key, shape);
        shape.name = name;
        return shape;
    }

private:
    Shape build(const TableReader& reader, const std::filesystem::path& file, double scale, bool open) {
        TriangleSoup soup = read_mesh(file);
        warnings_.insert(warnings_.end(), soup.notes.begin(), soup.notes.end());
        for (Vec3& vertex : soup.vertices) vertex *= scale;
        const std::string mesh = "mesh '" + file.string() + "' ";
        if (const MeshDefects defects = inspect(soup); !open && !defects.closed())
            throw Error(reader.where("file"),
                        mesh + main_defect(defects) + (defects.first.empty() ? "" : ": " + defects.first));
        try {
            return open ? make_surface("", soup) : make_mesh("", soup);
        } catch (const std::invalid_argument& error) {
            throw Error(reader.where("file"), mesh + "cannot be used: " + error.what());
        }
    }

    std::vector<std::string>& warnings_;
    std::map<std::tuple<std::filesystem::path, double, bool>, Shape> shapes_;
};

Shape read_capsule_shape(TableReader& reader, const std::string& name) {
    reader.require("radius");
    reader.require("half_height");
    return make_capsule(name, reader.number("radius", 0, positive), reader.number("half_height", 0, non_negative));
}

// Of the file's vertices, whatever its triangles are.
Shape read_hull(TableReader& reader, const std::string& name, std::vector<std::string>& warnings) {
    TriangleSoup soup = read_mesh(reader.path("file"));
    const double scale = reader.number("scale", 1, positive);
    warnings.insert(warnings.end(), soup.notes.begin(), soup.notes.end());
    for (Vec3& vertex : soup.vertices) vertex *= scale;
    try {
        return make_hull(name, soup.vertices);
    } catch (const std::invalid_argument& error) {
        throw Error(reader.where("file"), std::string("no hull can be made of this file: ") + error.what());
    }
}

Shape read_shape(TableReader& reader, const std::string& name, MeshCache& meshes, std::vector<std::string>& warnings) {
    reader.require("kind");
    const std::string kind = reader.text("kind", "");
    reader.choice("kind", "", shape_kinds);
    if (kind == "sphere") return read_sphere(reader, name);
    if (kind == "box") return read_box(reader, name);
    if (kind == "half_space") return read_half_space(reader, name);
    if (kind == "capsule") return read_capsule_shape(reader, name);
    if (kind == "hull") return read_hull(reader, name, warnings);
    return meshes.read(reader, name);
}

Material read_material(TableReader& reader, const std::string& name) {
    Material material;
    material.name = name;
    material.restitution = reader.number("restitution", material.restitution, {0, 1});
    material.friction = reader.number("friction", material.friction, non_negative);
    material.density = reader.number("density", material.density, positive);
    return material;
}

}  // namespace

void NameTable::add(const std::string& name, std::uint32_t index, const SourceLocation& where) {
    const auto [entry, is_new] = entries_.try_emplace(name, Entry{index, where});
    if (!is_new)
        throw Error(where, "there is a " + what_ + " '" + name + "' already, at " + to_string(entry->second.where));
}

std::uint32_t NameTable::find(const std::string& name, const SourceLocation& where) const {
    const auto entry = entries_.find(name);
    if (entry != entries_.end()) return entry->second.index;
    std::vector<std::string> names;
    for (const auto& [known, unused] : entries_) names.push_back(known);
    throw Error(where, "there is no " + what_ + " '" + name + "'" + hint(name, names));
}

NameTable read_materials(const toml::table& config, World& world) {
    NameTable names("material");
    world.materials.push_back({});
    for (const toml::table* table : tables(config, "material")) {
        TableReader reader(*table, "[[material]]");
        const std::string name = read_name(reader, "material");
        names.add(name, static_cast<std::uint32_t>(world.materials.size()), reader.where("name"));
        world.materials.push_back(read_material(reader, name));
        reader.finish();
    }
    return names;
}

NameTable read_shapes(const toml::table& config, World& world, std::vector<std::string>& warnings) {
    NameTable names("shape");
    MeshCache meshes(warnings);
    for (const toml::table* table : tables(config, "shape")) {
        TableReader reader(*table, "[[shape]]");
        const std::string name = read_name(reader, "shape");
        names.add(name, static_cast<std::uint32_t>(world.shapes.size()), reader.where("name"));
        world.shapes.push_back(read_shape(reader, name, meshes, warnings));
        reader.finish();
    }
    return names;
}

}  // namespace kolize::config
