#include "core/error.h"
#include "core/paths.h"
#include "ledger/accuracy/accuracy.h"
#include "ledger/accuracy/rows_json.h"

namespace livery {

std::filesystem::path accuracy_file() { return user_folder() / "accuracy.json"; }

void write_accuracy(const std::filesystem::path& file, const AccuracyLedger& ledger) {
    make_output_folder(file.parent_path());
    Json rows = Json::array();
    for (const AccuracyRow& row : ledger.rows) {
        if (row.called_for) rows.push_back(json_of(row));
    }
    write_json_file(file,
                    {{"format_version", 1},
                     {"unit", "CIEDE2000"},
                     {"renderer", ledger.renderer},
                     {"threads", ledger.threads},
                     {"samples_per_pixel", ledger.samples_per_pixel},
                     {"rows", rows}});
}

AccuracyLedger parse_accuracy(const std::string& text, const std::filesystem::path& file) {
    constexpr double kMost = 1e6;
    const Json json = parse_json(text, file);
    const JsonReader root(file, json);
    root.require_format_version(1);
    AccuracyLedger ledger;
    ledger.renderer = root["renderer"].text();
    ledger.threads = static_cast<int>(root["threads"].number_between(1.0, kMost));
    ledger.samples_per_pixel =
        static_cast<int>(root["samples_per_pixel"].number_between(1.0, kMost));
    const JsonReader rows = root["rows"];
    for (std::size_t i = 0; i < rows.size(); ++i) {
        AccuracyRow row = read_row(rows.at(i));
        if (row.index >= 0) ledger.rows.push_back(std::move(row));
    }
    return ledger;
}

KnownAccuracy known_accuracy() {
    std::error_code error;
    std::filesystem::path file;
    try {
        file = accuracy_file();
    } catch (const FileError&) {
        // No home folder to keep one in
    }
    const bool measured_here = !file.empty() && std::filesystem::exists(file, error);
    if (!measured_here) file = shipped_path("assets/ledger/accuracy.json");
    return {parse_accuracy(read_text_file(file), file), measured_here};
}

}  // namespace livery
