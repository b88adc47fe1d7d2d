// What is checked of the source as text:
//
// - Who may include whom: every #include "folder/file.h" of src/ against the list in
//   docs/architecture.md, which names every folder of src/ and has no circle.
// - Where other people's headers stay: every #include <header> against the second list there.
// - Nightly tests: tests/README.md has a row for each, and what it says stands in by day is there.
// - Errors: none is kept by a std::max() that a NaN leaves as it was.
//
// The first and the last are also tried on planted faults.
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "support/temporary_folder.h"

namespace livery {
namespace {

using Names = std::set<std::string>;
using Table = std::map<std::string, Names>;

struct Rules {
    Table may_include;   ///< folder -> folders
    Table foreign_home;  ///< start of another library's header -> folders or files that may name it
};

std::string text_of(const std::filesystem::path& file) {
    std::ifstream stream(file);
    std::ostringstream text;
    text << stream.rdbuf();
    return text.str();
}

/// The items "- `name`: `a`, `b`. Words." under a heading, up to the first full stop.
Table read_list(const std::string& markdown, const std::string& heading) {
    Table table;
    std::istringstream lines(markdown);
    bool inside = false;
    static const std::regex item("^- `([^`]+)`: (.*)$"), name("`([^`]+)`");
    for (std::string line; std::getline(lines, line);) {
        if (line.starts_with("## ")) inside = line == "## " + heading;
        std::smatch match;
        if (!inside || !std::regex_match(line, match, item)) continue;
        const std::string rest = match[2];
        const std::string list = rest.substr(0, rest.find(". "));
        auto& names = table[match[1]];
        for (std::sregex_iterator it(list.begin(), list.end(), name), end; it != end; ++it) {
            names.insert((*it)[1]);
        }
    }
    return table;
}

Rules read_rules(const std::filesystem::path& source) {
    const auto text = text_of(source / "docs/architecture.md");
    return {read_list(text, "Who may include whom"),
            read_list(text, "Where other people's headers stay")};
}

bool is_source(const std::filesystem::path& file) {
    return file.extension() == ".h" || file.extension() == ".cpp" || file.extension() == ".inc";
}

/// Every include of src/ that the rules forbid, as "folder/file.cpp:7: why".
std::vector<std::string> violations(const std::filesystem::path& source, const Rules& rules) {
    static const std::regex include(R"(^\s*#\s*include\s*([<"])([^>"]+)[>"].*$)");
    std::vector<std::string> found;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(source / "src")) {
        if (!is_source(entry.path())) continue;
        const auto file = std::filesystem::relative(entry.path(), source / "src").generic_string();
        const auto folder = file.substr(0, file.find('/'));
        const auto allowed = rules.may_include.find(folder);
        std::istringstream lines(text_of(entry.path()));
        int number = 0;
        for (std::string line; std::getline(lines, line);) {
            ++number;
            std::smatch match;
            if (!std::regex_match(line, match, include)) continue;
            const std::string target = match[2];
            const auto place = file + ":" + std::to_string(number) + ": ";
            if (match[1] == "\"") {
                const auto to = target.substr(0, target.find('/'));
                if (target.find('/') == std::string::npos) {
                    found.push_back(place + target + " is not named from its folder");
                } else if (to != folder &&
                           (allowed == rules.may_include.end() || !allowed->second.contains(to))) {
                    found.push_back(place + folder + " may not include " + target);
                }
            } else {
                for (const auto& [start, homes] : rules.foreign_home) {
                    if (target.starts_with(start) && !homes.contains(folder) &&
                        !homes.contains(file)) {
                        found.push_back(place + "<" + target + "> stays in " + *homes.begin());
                    }
                }
            }
        }
    }
    return found;
}

/// What .ci/nightly alone runs: "Suite.NightlyTest", and "suite `name`" for whole executables.
Names nightly_tests(const std::filesystem::path& source) {
    static const std::regex test(R"(\nTEST(?:_F|_P)?\(\s*(\w+),\s*(\w*Nightly\w*)\))"),
        suite(R"((?:livery_test\(|NAME )(\w+) (?:ALL_NIGHTLY|CONFIGURATIONS nightly))");
    Names found;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(source / "tests")) {
        const bool is_cmake = entry.path().filename() == "CMakeLists.txt";
        if (!is_cmake && entry.path().extension() != ".cpp") continue;
        const std::string text = text_of(entry.path());
        for (std::sregex_iterator it(text.begin(), text.end(), is_cmake ? suite : test), end;
             it != end;
             ++it) {
            found.insert(is_cmake ? "suite " + it->str(1) : it->str(1) + "." + it->str(2));
        }
    }
    return found;
}

/// The same as tests/README.md names them, in the first column of its table.
Names nightly_rows(const std::filesystem::path& source) {
    static const std::regex name(R"((suite )?`(\w+(?:\.\w*Nightly\w*)?)`)");
    const std::string all = text_of(source / "tests/README.md");
    const std::string text =
        all.substr(all.find("## Tests of the night"),
                   all.find("## Tests that can fail") - all.find("## Tests of the night"));
    Names found;
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);) {
        if (!line.starts_with("| `") && !line.starts_with("| suite `")) continue;
        const std::string tests = line.substr(0, line.find(" | "));
        for (std::sregex_iterator it(tests.begin(), tests.end(), name), end; it != end; ++it)
            found.insert(it->str(1) + it->str(2));
    }
    return found;
}

/// What the last column of that table says is asked at each change ("Suite.Test", "Suite.Begin*",
/// "Suite.*"), and no test is.
std::vector<std::string> day_names_of_no_test(const std::filesystem::path& source) {
    static const std::regex test(R"(\nTEST(?:_F|_P)?\(\s*(\w+),\s*(\w+)\))"),
        name(R"(`((?:\w+/)?(\w+)\.(\w*)(\*?))`)");
    std::string tests;  // one a line
    for (const auto& entry : std::filesystem::recursive_directory_iterator(source / "tests")) {
        if (entry.path().extension() != ".cpp") continue;
        const std::string text = text_of(entry.path());
        for (std::sregex_iterator it(text.begin(), text.end(), test), end; it != end; ++it)
            if (it->str(2).find("Nightly") == std::string::npos)
                tests += "\n" + it->str(1) + "." + it->str(2) + "\n";
    }
    std::vector<std::string> found;
    std::istringstream lines(text_of(source / "tests/README.md"));
    for (std::string line; std::getline(lines, line);) {
        if (line.find("Nightly") == std::string::npos || !line.starts_with("| `")) continue;
        const std::string day = line.substr(line.rfind(" | ", line.size() - 3));
        for (std::sregex_iterator it(day.begin(), day.end(), name), end; it != end; ++it) {
            const std::string begins = "\n" + it->str(2) + "." + it->str(3);
            if (tests.find(it->str(4).empty() ? begins + "\n" : begins) == std::string::npos)
                found.push_back(it->str(1));
        }
    }
    return found;
}

/// Errors that a NaN leaves as they were: std::max(worst, NaN) is `worst` (core/worst_error.h has
/// what to write instead). By their names, some where absolute values are kept. Whole numbers are
/// never NaN.
std::vector<std::string> errors_deaf_to_nan(const std::filesystem::path& source) {
    static const std::regex kept(
        R"(([\w.]*(worst|error|deviation|violation|change)\w*) = std::max\()"
        R"(|([\w.]*(?:largest|steepest|off|apart)) =\s+std::max\(\{?\s*\3,\s*(static_cast<double>\()?(std::abs|glm::distance)\()");
    static const std::regex whole(R"(^[^;]*static_cast<int>[^;]*;)");
    std::vector<std::string> found;
    for (const char* folder : {"src", "tests"}) {
        if (!std::filesystem::exists(source / folder)) continue;
        for (const auto& entry : std::filesystem::recursive_directory_iterator(source / folder)) {
            if (!is_source(entry.path())) continue;
            const std::string text = text_of(entry.path());
            for (std::sregex_iterator it(text.begin(), text.end(), kept), end; it != end; ++it) {
                const auto at = text.begin() + it->position();
                if (std::regex_search(std::string(at, std::min(at + 300, text.end())), whole)) {
                    continue;
                }
                found.push_back(std::filesystem::relative(entry.path(), source).generic_string() +
                                ":" + std::to_string(1 + std::count(text.begin(), at, '\n')) +
                                ": " + it->str());
            }
        }
    }
    return found;
}

std::string joined(const std::vector<std::string>& lines) {
    std::string text;
    for (const auto& line : lines) text += line + "\n";
    return text;
}

const std::filesystem::path kSource = LIVERY_SOURCE;

TEST(Layering, TheListNamesEveryFolder) {
    const auto rules = read_rules(kSource);
    Names listed, present;
    for (const auto& [folder, allowed] : rules.may_include) listed.insert(folder);
    for (const auto& entry : std::filesystem::directory_iterator(kSource / "src")) {
        if (entry.is_directory()) present.insert(entry.path().filename().string());
    }
    EXPECT_EQ(listed, present);
    EXPECT_FALSE(rules.foreign_home.empty());
}

TEST(Layering, TheListHasNoCircle) {
    auto rest = read_rules(kSource).may_include;
    for (bool shrunk = true; shrunk;) {
        shrunk = false;
        for (auto it = rest.begin(); it != rest.end();) {
            bool free = true;
            for (const auto& name : it->second) free = free && !rest.contains(name);
            shrunk = shrunk || free;
            it = free ? rest.erase(it) : std::next(it);
        }
    }
    for (const auto& [folder, allowed] : rest) ADD_FAILURE() << folder << " is in a circle";
}

TEST(Layering, NoIncludeIsForbidden) {
    const auto found = violations(kSource, read_rules(kSource));
    EXPECT_TRUE(found.empty()) << joined(found);
}

/// As docs/architecture.md lists them, in the sentence after "A folder of `studio/` includes".
std::vector<std::string> order_of_studio(const std::filesystem::path& source) {
    const std::string text = text_of(source / "docs/architecture.md");
    const auto from = text.find("which a test sees to:");
    static const std::regex name(R"(`(\w+)`)");
    const std::string list = text.substr(from, text.find("\n\n", from) - from);
    std::vector<std::string> order;
    for (std::sregex_iterator it(list.begin(), list.end(), name), end; it != end; ++it) {
        order.push_back((*it)[1]);
    }
    return order;
}

TEST(Layering, AFolderOfTheStudioIncludesThoseBeforeItAlone) {
    const auto order = order_of_studio(kSource);
    const auto place = [&](const std::string& file) {
        const auto folder = std::filesystem::path(file).parent_path().filename().string();
        // One that is not named stands beside the last: no other may include it.
        return std::min(std::find(order.begin(), order.end(), folder), std::prev(order.end())) -
               order.begin();
    };
    static const std::regex include(R"x(#include "(studio/[^"]+)")x");
    for (const auto& entry :
         std::filesystem::recursive_directory_iterator(kSource / "src/studio")) {
        if (!is_source(entry.path())) continue;
        const std::string text = text_of(entry.path());
        for (std::sregex_iterator it(text.begin(), text.end(), include), end; it != end; ++it) {
            EXPECT_LE(place((*it)[1]), place(entry.path().string()))
                << entry.path() << " includes " << (*it)[1];
        }
    }
}

TEST(Layering, PlantedIncludesAreFound) {
    const auto rules = read_rules(kSource);
    const TemporaryFolder folder;
    std::filesystem::create_directories(folder / "src/twin");
    std::filesystem::create_directories(folder / "src/core");
    folder.write("src/twin/a.cpp",
                 "#include <vector>\n#include \"core/image.h\"\n#include \"twin/bench.h\"\n"
                 "#include \"calibration/correspondence/gray_code.h\"\n#  include "
                 "\"compensation/gpu_pass.h\"\n");
    folder.write("src/core/b.h",
                 "#include \"mesh/mesh.h\"\n#include <embree3/rtcore.h>\n"
                 "#include <embree4/rtcore.h>\n");
    folder.write("src/core/c.cpp", "#include \"c.h\"\n#include <OpenImageIO/imageio.h>\n");
    const auto found = violations(folder.path(), rules);
    const auto text = joined(found);
    EXPECT_EQ(found.size(), 7u) << text;
    for (const char* part :
         {"twin/a.cpp:4: twin may not include calibration/correspondence/gray_code.h",
          "twin/a.cpp:5: twin may not include compensation/gpu_pass.h",
          "core/b.h:1: core may not include mesh/mesh.h",
          "core/b.h:2: <embree3/rtcore.h> stays in tracing",
          "core/b.h:3: <embree4/rtcore.h> stays in tracing",
          "core/c.cpp:1: c.h is not named from its folder",
          "core/c.cpp:2: <OpenImageIO/imageio.h> stays in core/pictures/image_io"}) {
        EXPECT_NE(text.find(part), std::string::npos) << part << " not in\n" << text;
    }
}

TEST(Nightly, TheReadmeNamesAllThatRunsAtNight) {
    const auto tests = nightly_tests(kSource);
    EXPECT_GT(tests.size(), 5u);
    EXPECT_EQ(tests, nightly_rows(kSource));
    const auto none = day_names_of_no_test(kSource);
    EXPECT_TRUE(none.empty()) << joined(none);
}

TEST(Errors, NoneIsDeafToNan) {
    const auto found = errors_deaf_to_nan(kSource);
    EXPECT_TRUE(found.empty()) << joined(found);
}

TEST(Errors, PlantedOnesAreFound) {
    const TemporaryFolder folder;
    std::filesystem::create_directories(folder / "src/core");
    folder.write("src/core/a.cpp",
                 "row.worst = "
                 "std::max(row.worst, x);\n"
                 "worst = worse_of(worst, x);\n"
                 "largest = "
                 "std::max(largest,\n std::abs(a - b));\n"
                 "largest = "
                 "std::max(largest, std::abs(static_cast<int>(a)));\n"
                 "high = "
                 "std::max(high, value);\n");
    EXPECT_EQ(joined(errors_deaf_to_nan(folder.path())),
              "src/core/a.cpp:1: row.worst = "
              "std::max(\n"
              "src/core/a.cpp:3: largest = "
              "std::max(largest,\n std::abs(\n");
}

}  // namespace
}  // namespace livery
