// kolize massprops: volume, centre of mass, inertia and bounding volumes of a triangle mesh.
#include "massprops/prompt.h"
#include "massprops/result.h"
#include "massprops/study.h"
#include "massprops/slow_methods.h"

#include <kolize/mesh_io.h>

#include <nlohmann/json.hpp>

#include <CLI/CLI.hpp>

#include <unistd.h>

#include <iostream>

namespace kolize::cli {
namespace {

constexpr double default_step = -100;

void choose_values(MassPropsResult& result) {
    const Model& model = result.model;
    if (model.bounds_volume()) result.exact = mass_properties(model.surface);
    if (result.options.wants_voxels() || !result.exact) {
        TimedVoxels voxels = run_voxels(model.surface, result.options, result.options.step.value_or(default_step));
        result.voxel = std::move(voxels.result);
        result.voxel_seconds = voxels.seconds;
    }
    if (!result.exact) result.estimate = run_estimate(model.surface, result.options);
    if (result.options.wants_voxels()) {
        result.method = "voxel";
        result.mass = result.voxel->mass;
    } else {
        result.method = result.exact ? "exact" : "winding number";
        result.mass = result.exact ? *result.exact : result.estimate->mass;
    }
}

void refuse_exact(const Model& model) {
    throw Error(model.surface.file + ": exact integrals need a surface that bounds a volume, and this one does not: " +
                model.defects.first + " (without --method exact there are estimates)");
}

MassPropsResult compute(const MassPropsOptions& options, const Model& model) {
    if (options.method == "exact" && !model.bounds_volume()) refuse_exact(model);
    MassPropsResult result{options, model, {}, {}, {}, {}, {}, {}, {}, 0};
    choose_values(result);
    result.principal = principal_frame(result.mass.inertia_over_mass);
    result.bounds = bounding_volumes(model.surface, result.mass.center_of_mass);
    return result;
}

// Moments of a body are positive, and none is more than the other two together.
bool is_of_a_body(const Vec3& moments) {
    const double sum = moments.sum(), rounding = 1e-12 * moments.cwiseAbs().sum();
    return moments.minCoeff() >= -rounding && moments.maxCoeff() <= sum - moments.maxCoeff() + rounding;
}

void warn(const MassPropsResult& result) {
    const std::string& file = result.model.surface.file;
    if (!result.model.bounds_volume())
        std::cerr << "kolize: " << file << " does not bound a volume; the values are estimates\n";
    else if (!is_of_a_body(result.principal.moments))
        std::cerr << "kolize: " << file << " has parts that are inside out; no body has the moments that result\n";
}

// One of the two is given: refuse_contradictions saw to it.
double mass_in_kg(const MassPropsOptions& options, const MassPropsResult& result) {
    if (options.mass) return *options.mass;
    return *options.density * result.mass.volume;
}

void write_outputs(const MassPropsOptions& options, const MassPropsResult& result) {
    const bool text = options.format == "text";
    if (!text && (result.mass.volume <= 0 || !is_of_a_body(result.principal.moments)))
        throw Error(options.model + ": no body has the inertia that was found, so none is written");
    if (!options.output.empty()) write_mesh(recentred(result), options.output);
    if (!options.json.empty() && options.json != "-") write_json(to_json(result), options.json);
    if (!text) {
        std::cout << inertial_element(options.format, result.mass, mass_in_kg(options, result));
    } else if (options.json != "-") {
        print_text(result, std::cout);
    } else {
        write_json(to_json(result), "-");
    }
}

void study(const MassPropsOptions& options, const Model& model) {
    const Study study = run_study(model, options);
    if (!options.plot.empty()) write_text(plot_svg(study, options.model + ": voxel method"), options.plot);
    if (!options.json.empty()) {
        Json json = to_json(study);
        json["model"] = options.model;
        json["host"] = host_block();
        json["command"] = command_line();
        write_json(json, options.json);
    }
    if (options.json == "-") return;
    std::cout << options.model << ": the voxel method at " << study.rows.size() << " steps\n\n";
    print_text(study, std::cout);
}

void refuse_contradictions(const MassPropsOptions& options) {
    std::error_code error;
    if (options.format != "text" && options.json == "-")
        throw Error("--format " + options.format + " and --json - both want stdout; give --json a file");
    if (options.format != "text" && !options.mass && !options.density)
        throw Error("--format " + options.format +
                    " needs the mass of the body: give --mass (kg) or --density (kg/m^3)");
    if (!options.study.empty() && (options.step || options.format != "text" || !options.output.empty()))
        throw Error("--study prints errors over its own steps; it takes no STEP, --format or --output");
    if (!options.plot.empty() && options.study.empty()) throw Error("--plot shows a --study; give its steps");
    if (options.method == "exact" && options.step) throw Error("--method exact takes no step; leave one of them out");
    if (!options.output.empty() && std::filesystem::equivalent(options.model, options.output, error))
        throw Error("--output " + options.output + " would overwrite the model");
}

void massprops(MassPropsOptions options) {
    if (options.model.empty()) {
        if (!isatty(STDIN_FILENO)) throw Error("massprops needs a model: kolize massprops MODEL [STEP [AXES]]");
        ask_for(options, std::cin, std::cout);
    }
    refuse_contradictions(options);
    const Model model = load_model(options.model, options.scale);
    if (!options.study.empty()) return study(options, model);
    const MassPropsResult result = compute(options, model);
    warn(result);
    write_outputs(options, result);
}

// CLI::PositiveNumber takes NaN for one.
std::string positive_complaint(const std::string& text) {
    double value = 0;
    if (CLI::detail::lexical_cast(text, value) && value > 0 && std::isfinite(value)) return "";
    return "a number greater than 0 is wanted, not " + text;
}

void add_voxel_options(CLI::App& command, MassPropsOptions& options) {
    command.add_option("--rays", options.rays, "Who casts the rays: rasteriser or embree")
        ->check(CLI::IsMember({"rasteriser", "embree"}))
        ->capture_default_str();
    const auto set_count = [&options](const std::string& name) {
        options.voxel.count = VoxelCount::analytic;
        if (name == "midpoint") options.voxel.count = VoxelCount::midpoint;
        if (name == "thesis") options.voxel.count = VoxelCount::thesis;
    };
    command
        .add_option_function<std::string>("--count", set_count, "What counts along a ray: analytic, midpoint or thesis")
        ->check(CLI::IsMember({"analytic", "midpoint", "thesis"}))
        ->default_str("analytic");
    const auto set_sum = [&options](const std::string& name) {
        options.voxel.sum = name == "float" ? VoxelSum::single_precision : VoxelSum::double_precision;
    };
    command.add_option_function<std::string>("--sum", set_sum, "What sums run in: double or float")
        ->check(CLI::IsMember({"double", "float"}))
        ->default_str("double");
    command
        .add_option("--grid-shift", options.voxel.grid_shift,
                    "Moves all rays by this part of the spacing (-0.5 to 0.5)")
        ->capture_default_str();
    command.add_option("--study", options.study, "Convergence over these steps (comma separated)")->delimiter(',');
    command.add_option("--plot", options.plot, "Write the study's errors as a picture (SVG) to this file");
}

}  // namespace

void add_massprops(CLI::App& app) {
    const auto options = std::make_shared<MassPropsOptions>();
    options->threads = all_cores();
    CLI::App* command =
        app.add_subcommand("massprops", "Volume, centre of mass, inertia and bounding volumes of a mesh");
    command->add_option("model", options->model, "OBJ, OFF, PLY, STL or WRL file; without it the terminal is asked");
    command->add_option("step", options->step,
                        "For the voxel method: > 0 spacing of the rays, < 0 divisions of the longest side");
    command->add_option("axes", options->voxel.axes, "Number of axes along which rays go")->check(CLI::Range(1, 3));
    command->add_option("--method", options->method, "exact or voxel (default: voxel if a step is given, else exact)")
        ->check(CLI::IsMember({"exact", "voxel"}));
    command->add_option("--scale", options->scale, "Factor on all lengths first (0.001: millimetres to metres)")
        ->check(positive_complaint);
    add_voxel_options(*command, *options);
    command->add_option("--output", options->output,
                        "Write the model about its centre of mass (.wrl with all results, .obj, .off, .ply, .stl)");
    command->add_option("--format", options->format, "text, or the inertial element of urdf, mjcf or sdf")
        ->check(CLI::IsMember({"text", "urdf", "mjcf", "sdf"}))
        ->capture_default_str();
    CLI::Option* mass = command->add_option("--mass", options->mass, "Mass in kg")->check(positive_complaint);
    command->add_option("--density", options->density, "Density in kg/m^3")->check(positive_complaint)->excludes(mass);
    add_threads_option(*command, options->threads);
    add_json_option(*command, options->json);
    command->footer(
        "Example: kolize massprops fighter.obj\n"
        "         kolize massprops fighter.obj -600 3 --json -\n"
        "         kolize massprops cube.obj --study 50,10,5,2.5 --plot convergence.svg\n"
        "         kolize massprops part.stl --scale 0.001 --format urdf --density 2700");
    command->callback([options] { massprops(*options); });
}

}  // namespace kolize::cli
