// The tables of docs/materials.md are those of the program. LIVERY_REPRINT=1 writes them anew.
#include <cstdlib>
#include <string>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gtest/gtest.h>

#include "appearance/model_table.h"
#include "core/paths.h"

namespace livery {
namespace {

std::string models_as_table() {
    std::string text =
        "| model | what it is | parameters | reciprocal | conserves energy |\n"
        "| --- | --- | --- | --- | --- |\n";
    for (const ModelInfo& model : formula_models()) {
        text += fmt::format("| `{}` | {} | `{}` | {} | {} |\n",
                            model.name,
                            model.meaning,
                            fmt::join(model.parameters, "`, `"),
                            model.reciprocal ? "yes" : "no",
                            model.conserves_energy ? "yes" : "no");
    }
    return text;
}

std::string parameters_as_table() {
    std::string text =
        "| parameter | in the desktop | meaning | range | a new paint's |\n"
        "| --- | --- | --- | --- | --- |\n";
    for (const ParameterInfo& parameter : parameter_table()) {
        text +=
            fmt::format("| `{}` | {} | {} | {} | {} |\n",
                        parameter.name,
                        parameter.label,
                        parameter.meaning,
                        parameter.kind == ParameterKind::pair
                            ? parameter.range_text() + ", one number or `[along, across]`"
                            : parameter.range_text(),
                        parameter.default_text() + (parameter.optional ? ", also in files" : ""));
    }
    return text;
}

/// What stands between a line with the mark and the next empty line.
void expect_table(std::string& docs, const std::string& mark, const std::string& table) {
    const std::string line = "<!-- " + mark + " -->\n";
    const auto at = docs.find(line);
    ASSERT_NE(at, std::string::npos) << mark;
    const auto begin = at + line.size();
    const auto end = docs.find("\n\n", begin) + 1;
    ASSERT_NE(end, std::string::npos + 1);
    if (!std::getenv("LIVERY_REPRINT")) {
        EXPECT_EQ(docs.substr(begin, end - begin), table);
    }
    docs.replace(begin, end - begin, table);
}

TEST(Docs, HaveTheTablesOfTheProgram) {
    const std::string file = LIVERY_MATERIALS_PAGE;
    std::string docs = read_text_file(file);
    expect_table(docs, "models", models_as_table());
    expect_table(docs, "parameters", parameters_as_table());
    if (std::getenv("LIVERY_REPRINT")) write_text_file(file, docs);
}

}  // namespace
}  // namespace livery
