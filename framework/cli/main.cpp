#include "common.h"

#include <CLI/CLI.hpp>

#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>

#include <iostream>

namespace {

enum ExitCode { fine = 0, failed = 1, bad_input = 2 };

int complain(const std::string& sentence, int code) {
    std::cerr << "kolize: " << sentence << '\n';
    return code;
}

int parse_and_run(CLI::App& app, int argc, char** argv, const int& exit_code) {
    try {
        app.parse(argc, argv);
        return exit_code;
    } catch (const CLI::ParseError& error) {
        if (error.get_exit_code() == 0) return app.exit(error);  // --help, --version
        return complain(std::string(error.what()) + " (see kolize --help)", bad_input);
    } catch (const kolize::Error& error) {
        return complain(error.what(), bad_input);
    } catch (const std::exception& error) {
        return complain(error.what(), failed);
    }
}

}  // namespace

int main(int argc, char** argv) {
    spdlog::set_default_logger(spdlog::stderr_color_st("kolize"));
    spdlog::set_pattern("%^%l%$: %v");

    CLI::App app("Rigid-body collision by plugins: runs scenes, compares pipelines, measures both.", "kolize");
    app.set_version_flag("--version",
                         "kolize " KOLIZE_VERSION " (plugin API " + std::to_string(kolize::plugin_api) + ")");
    app.require_subcommand(1);
    app.footer(
        "Example: kolize run scene.toml --set broadphase.plugin=brute_force\n"
        "Exit codes: 0 fine, 1 a run failed or broke an expectation, 2 bad input or usage.");
    int exit_code = fine;
    kolize::cli::add_run(app, exit_code);
    kolize::cli::add_view(app, exit_code);
    kolize::cli::add_compare(app, exit_code);
    kolize::cli::add_advise(app, exit_code);
    kolize::cli::add_explain(app, exit_code);
    kolize::cli::add_bench(app, exit_code);
    kolize::cli::add_check(app, exit_code);
    kolize::cli::add_stability(app);
    kolize::cli::add_massprops(app);
    kolize::cli::add_plugins(app, exit_code);
    return parse_and_run(app, argc, argv, exit_code);
}
