#include "core/text/markup.h"

#include "core/error.h"
#include "core/paths.h"

namespace livery {

std::string html_escaped(std::string_view text) {
    std::string safe;
    for (const char c : text) {
        switch (c) {
            case '<':
                safe += "&lt;";
                break;
            case '>':
                safe += "&gt;";
                break;
            case '&':
                safe += "&amp;";
                break;
            case '"':
                safe += "&quot;";
                break;
            default:
                safe += c;
        }
    }
    return safe;
}

namespace {

struct Block {
    std::string text;                ///< of the whole file
    std::size_t begin = 0, end = 0;  ///< of what stands between the two lines
};

Block find_block(const std::filesystem::path& file, const std::string& mark) {
    const std::string first = "<!-- " + mark + ": begin -->", last = "<!-- " + mark + ": end -->";
    Block block;
    block.text = read_text_file(file);
    block.begin = block.text.find(first + "\n");
    block.end = block.text.find(last + "\n");
    if (block.begin == std::string::npos || block.end == std::string::npos ||
        block.end < block.begin) {
        throw FileError(file,
                        "text",
                        "no lines to write between",
                        "a line \"" + first + "\" and below it \"" + last + "\"");
    }
    block.begin += first.size() + 1;
    return block;
}

}  // namespace

void replace_marked_block(const std::filesystem::path& file,
                          const std::string& mark,
                          const std::string& text) {
    const Block block = find_block(file, mark);
    write_text_file(file, block.text.substr(0, block.begin) + text + block.text.substr(block.end));
}

void check_marked_block(const std::filesystem::path& file, const std::string& mark) {
    find_block(file, mark);
}

}  // namespace livery
