// What helps somebody elsewhere to find out why something failed here: one archive that the user
// reads before sending it. Nothing is ever sent by the program.
#pragma once

#include <ctime>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/image.h"
#include "core/progress.h"
#include "gl/context.h"
#include "session/document.h"

namespace livery {

/// One file of the archive.
struct ReportFile {
    std::string name;     ///< "opengl.txt"
    std::string what;     ///< it holds, a sentence
    std::string bytes;    ///< of texts: without the home folder and the user's names
    std::string problem;  ///< why something is missing in it, which stands in its place; else empty
    bool is_text = true;  ///< else a picture
};

/// Of whom the report tells, and what it may tell.
struct ReportRequest {
    std::filesystem::path session;  ///< its calibration is told of; empty: of none
    /// The session as it is open in a window; nothing: the file's newest step is read.
    std::shared_ptr<const Document> document;
    /// Of a window: what it is drawn with, in words, and what the projector is sent.
    std::string drawn_with;
    std::shared_ptr<const Image8> sent_to_projector;

    bool with_session = false;   ///< looks, paints, and names of files, and the log's commands
    bool with_pictures = false;  ///< of the calibration and, `with_session`, of artwork
    bool with_votes = false;     ///< ballots of closed rounds, without names
};

/// OpenGL, monitors and cameras, each asked in a process of its own (livery report-problem --show),
/// side by side, so that one that crashes or hangs is a line of the report: ten seconds at most.
/// Any thread.
std::vector<ReportFile> ask_devices(GlDevice device, const Progress& progress = {});

/// What `--show` answers: one of "opengl", "display" and "cameras". Throws what the facts throw.
std::string device_facts(const std::string& of, GlDevice device);

/// The whole report in the archive's order, a README.txt that names every file first. What cannot
/// be found out says so in its place; throws Cancelled alone. Any thread; a second or two with a
/// large calibration.
std::vector<ReportFile> make_problem_report(const ReportRequest& request,
                                            const std::vector<ReportFile>& devices,
                                            const Progress& progress = {});

/// "livery-report-2026-11-28-223000.zip", of the local time.
std::string report_name(std::time_t now);

/// Throws FileError.
void write_problem_report(const std::filesystem::path& file,
                          const std::vector<ReportFile>& report,
                          std::time_t now);

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
