// What a person who edits a shader reads when it fails.
#include "gl/program.h"

#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>

#include <gtest/gtest.h>

#include "core/error.h"
#include "core/paths.h"
#include "gl/context.h"
#include "support/gl_device.h"

namespace livery {
namespace {

class ProgramTest : public ::testing::Test {
  protected:
    ProgramTest() : context_(tested_gl()) { set_gl_checks(true); }
    HeadlessContext context_;
};

TEST_F(ProgramTest, CompileErrorShowsTheNumberedLine) {
    try {
        Program::screen_pass({"broken.frag", R"(#version 450 core
out vec4 colour;
void main() {
    float a = 1.0;
    colour = vec4(undefined_name);
    float b = a;
}
void never_shown() {}
)"});
        FAIL() << "compiled";
    } catch (const std::runtime_error& error) {
        const std::string message = error.what();
        EXPECT_NE(message.find("shader broken.frag does not compile"), std::string::npos)
            << message;
        EXPECT_NE(message.find("undefined_name"), std::string::npos) << message;
        EXPECT_NE(message.find("> 5 |     colour = vec4(undefined_name);"), std::string::npos)
            << message;
        EXPECT_NE(message.find("  4 |     float a = 1.0;"), std::string::npos) << message;
        EXPECT_EQ(message.find("never_shown"), std::string::npos) << message;
    }
}

TEST_F(ProgramTest, LinkErrorNamesBothStages) {
    try {
        Program(ShaderSource{"a.vert", "#version 450 core\nvoid main() { gl_Position = vec4(0); }"},
                ShaderSource{"b.frag",
                             "#version 450 core\nin vec3 missing;\nout vec4 c;\n"
                             "void main() { c = vec4(missing, 1.0); }"});
        FAIL() << "linked";
    } catch (const std::runtime_error& error) {
        const std::string message = error.what();
        EXPECT_NE(message.find("program a.vert + b.frag does not link"), std::string::npos)
            << message;
        EXPECT_NE(message.find("missing"), std::string::npos) << message;
    }
}

class ShaderFiles : public ::testing::Test {
  protected:
    ShaderFiles() : folder_(std::filesystem::temp_directory_path() / "livery_shader_files_test") {
        std::filesystem::create_directories(folder_ / "shaders" / "lib");
        set_data_folder(folder_);
    }
    ~ShaderFiles() override {
        set_data_folder({});
        std::filesystem::remove_all(folder_);
    }
    void write(const std::string& name, const std::string& text) const {
        std::ofstream(folder_ / "shaders" / name) << text;
    }
    std::filesystem::path folder_;
};

TEST_F(ShaderFiles, IncludesEachFileOnceAndDefinesAfterTheVersion) {
    write("lib/pi.glsl", "const float pi = 3.14159;\n");
    write("lib/circle.glsl", "#include \"lib/pi.glsl\"\nfloat area(float r) { return pi*r*r; }\n");
    write("main.frag",
          "#version 450 core\n#include \"lib/pi.glsl\"\n  #include \"lib/circle.glsl\"\n"
          "void main() {}\n");
    const ShaderSource source = load_shader("main.frag", {"LOBES 3", "FLAKES"});
    EXPECT_EQ(source.name, "main.frag");
    EXPECT_EQ(source.text,
              "#version 450 core\n#define LOBES 3\n#define FLAKES\nconst float pi = 3.14159;\n"
              "float area(float r) { return pi*r*r; }\nvoid main() {}\n");
}

TEST_F(ShaderFiles, BadFilesAreNamed) {
    write("no_version.frag", "void main() {}\n");
    write("bad_include.frag", "#version 450 core\n#include <pi.glsl>\n");
    write("missing_include.frag", "#version 450 core\n#include \"lib/nothing.glsl\"\n");
    const auto message = [](const std::string& file) -> std::string {
        try {
            load_shader(file);
        } catch (const FileError& error) {
            return error.what();
        }
        return "no FileError";
    };
    EXPECT_NE(message("absent.frag").find("shaders/absent.frag"), std::string::npos);
    EXPECT_NE(message("no_version.frag").find("#version 450 core"), std::string::npos);
    EXPECT_NE(message("bad_include.frag").find("double quotes"), std::string::npos);
    EXPECT_NE(message("missing_include.frag").find("lib/nothing.glsl"), std::string::npos);
}

}  // namespace
}  // namespace livery
