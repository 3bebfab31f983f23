#include "cli/shell.h"

#include <nlohmann/json.hpp>

#include <catch2/catch.hpp>

#include <fstream>

using namespace kolize::test;
using nlohmann::json;

namespace {

// A folder with the library of one plugin, which is quick to check.
class OnePlugin {
public:
    explicit OnePlugin(const std::string& library = KOLIZE_PLUGIN_DIR "/response_slide.so") {
        std::filesystem::copy_file(library, file("own.so"));
    }

    std::filesystem::path file(const std::string& name) const { return shell.folder.path() / name; }
    Outcome certify(const std::string& path = "") const {
        return shell.kolize("plugins test own.so --certificate " + path);
    }
    json certificate(const std::string& name = "own.certificate.json") const {
        return json::parse(file_bytes(file(name)));
    }
    // What the list says of the plugin `slide`: the one of this folder.
    json state() const {
        const json list = json::parse(shell.kolize("plugins list --json --plugin-path .").out);
        for (const json& plugin : list.at("plugins"))
            if (plugin.at("name") == "slide") return plugin.at("certificate");
        return nullptr;
    }

    Shell shell;
};

}  // namespace

TEST_CASE("a certificate says which checks a library has passed", "[plugins]") {
    const OnePlugin one;
    REQUIRE(one.certify().code == 0);
    const json certificate = one.certificate();
    CHECK(certificate.at("plugin") == "slide");
    CHECK(certificate.at("stage") == "response");
    CHECK(certificate.at("seed") == 1);
    CHECK(certificate.at("plugin_api").is_number());
    CHECK_FALSE(certificate.at("version").get<std::string>().empty());
    CHECK_FALSE(certificate.at("compiler").get<std::string>().empty());
    CHECK(certificate.at("library").at("file") == "own.so");
    const json& checks = certificate.at("checks");
    const auto count = [&](const char* outcome) {
        return std::count_if(checks.begin(), checks.end(),
                             [&](const json& check) { return check.at("outcome") == outcome; });
    };
    CHECK(checks.size() > 20);
    CHECK(certificate.at("totals") == json{{"pass", count("pass")}, {"fail", 0}, {"skip", count("skip")}});
    CHECK(one.state() == json{{"state", "valid"}, {"pass", count("pass")}, {"skip", count("skip")}});
    const std::string list = one.shell.kolize("plugins list --plugin-path .").out;
    CHECK(list.find("certified: " + std::to_string(count("pass")) + " checks") != std::string::npos);
}

TEST_CASE("a certificate holds for one build of a library only", "[plugins]") {
    const OnePlugin one;
    CHECK(one.state() == json{{"state", "none"}});
    REQUIRE(one.certify().code == 0);
    SECTION("the library is another") { std::ofstream(one.file("own.so"), std::ios::app) << "one byte more"; }
    SECTION("the certificate is cut short") { std::ofstream(one.file("own.certificate.json")) << "{\"plugin\": \"sl"; }
    SECTION("the certificate is something else") { std::ofstream(one.file("own.certificate.json")) << "[1, 2]"; }
    SECTION("the certificate is not of this API") {
        json certificate = one.certificate();
        certificate["plugin_api"] = 1;
        std::ofstream(one.file("own.certificate.json")) << certificate;
    }
    CHECK(one.state() == json{{"state", "of another build"}});
    const std::string list = one.shell.kolize("plugins list --plugin-path .").out;
    CHECK(list.find("certificate is of another build") != std::string::npos);
}

TEST_CASE("a certificate can be written elsewhere, the same bytes again", "[plugins]") {
    const OnePlugin one;
    REQUIRE(one.certify("there.json").code == 0);
    REQUIRE(one.certify().code == 0);
    CHECK(file_bytes(one.file("there.json")) == file_bytes(one.file("own.certificate.json")));
    CHECK(one.shell.files() == 5);  // the library, two certificates, and what the program said: nothing half-written
}

TEST_CASE("checks can be made on other random input", "[plugins]") {
    const OnePlugin one;
    REQUIRE(one.certify("--seed 7").code == 0);
    CHECK(one.certificate().at("seed") == 7);
}

TEST_CASE("a certificate that cannot be written is one sentence", "[plugins]") {
    const OnePlugin one;
    const std::string library = file_bytes(one.file("own.so"));
    for (const char* path : {"no/such/folder/own.json", ".", "own.so"}) {
        CAPTURE(path);
        const Outcome outcome = one.certify(path);
        CHECK(outcome.code == 2);
        CHECK(std::count(outcome.err.begin(), outcome.err.end(), '\n') == 1);
        CHECK(outcome.err.find(path) != std::string::npos);
    }
    CHECK(file_bytes(one.file("own.so")) == library);
}

TEST_CASE("a plugin that fails a check gets no certificate", "[plugins]") {
    const OnePlugin one(KOLIZE_FALSE_CLAIM_DIR "/response_uses.so");
    CHECK(one.certify().code == 1);
    CHECK_FALSE(std::filesystem::exists(one.file("own.certificate.json")));
}
