// What a report tells of the session, its calibration, its pictures and votes.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/image.h"
#include "core/progress.h"
#include "session/document.h"
#include "studio/report/problem_report.h"

namespace livery {

// In all of them a document may be null: there is no session yet.

/// The document as JSON that people can read.
std::string session_part(const Document* document);

/// Figures of the document's calibration with their grades, what it was made for and with, its
/// projector's view, its files with their sizes, and what is wrong with them. What cannot be read
/// says so in its place; a document without a calibration is an answer, too.
std::string calibration_part(const Document* document, const Progress& progress);

/// The calibration's pictures and, `with_artwork`, those that its looks name. What is too large,
/// too much or cannot be read is a file that says so.
std::vector<ReportFile> picture_parts(const Document* document,
                                      bool with_artwork,
                                      const Progress& progress);

ReportFile sent_picture_part(const Image8& drive);

/// Each closed round's ballots in the user's folder, without names, in an order of chance.
std::vector<ReportFile> vote_parts(const std::filesystem::path& user_folder);

}  // namespace livery
