// The only ways in which a session changes: the same for panel, keys, command line and tests.
#pragma once

#include <filesystem>
#include <optional>
#include <set>
#include <string>
#include <variant>
#include <vector>

#include "session/document.h"

namespace livery {

struct SetPaint {
    int look = 0;
    std::string part;  ///< "*": every part that is not named
    std::string paint;
    std::string look_name{};  ///< that the look has from now on, made unique; empty: its own
};
/// One paint on every part, as a clay model wears it; what parts wore by themselves is taken off.
struct PaintProduct {
    int look = 0;
    std::string paint;
    std::string look_name{};  ///< same
};
/// For the look_name of both: that of a look which is named after the paint that one of them takes
/// off, and so would go on telling of another colour; empty for any other. `part` empty: the whole
/// product.
std::string look_name_after(const Look& look, const std::string& part, const std::string& paint);

/// Changes a paint's parameters on one part. A paint of the library, or one that other parts and
/// looks use as well, becomes the session's own under `material.name` with a number behind it.
struct EditPaint {
    int look = 0;
    std::string part;
    Material material;
};
/// One of the session's own paints by another name, wherever it is worn.
struct RenamePaint {
    std::string paint, name;
};
/// What lies over the paints of a look, as a whole: each over those before it.
struct SetArtwork {
    int look = 0;
    std::vector<Artwork> artwork;
};
struct AddLook {
    Look look;    ///< a new one, or what was read from a file; its name is made unique
    int at = -1;  ///< place in the list; -1: last
};
struct DuplicateLook {
    int look = 0;
};
struct RenameLook {
    int look = 0;
    std::string name;
};
struct DeleteLook {
    int look = 0;
};
struct MoveLook {
    int look = 0;
    int to = 0;
};
struct SetLights {
    int look = 0;
    std::vector<DirectionalLight> lights;
};
struct SetEnvironment {
    int look = 0;
    EnvironmentReference environment;
};
/// Gives every look the lights and the environment of this one, for a fair comparison.
struct ShareLighting {
    int look = 0;
};
/// By hand: the seats stay where they are.
struct SetEye {
    glm::dvec3 eye_mm{0.0};
};
/// A new seat, or another place for one.
struct SetSeat {
    int seat = 0;
    glm::dvec3 eye_mm{0.0};
    bool counts = true;  ///< in the mean of all seats
};
/// Where the eye was of this seat, it stays there, by hand.
struct RemoveSeat {
    int seat = 0;
};
/// All seats as a whole.
struct SetSeats {
    std::vector<EyeSeat> seats;
};
struct UseEye {
    EyeChoice choice;
};
struct SetExposure {
    double ev = 0.0;
};
struct SetQuality {
    Quality quality = Quality::normal;
    std::optional<EffectLevels> levels{};  ///< of effects one by one; none: the quality's
};
struct SetCalibration {
    std::string folder;  ///< empty: uncorrected
};
struct SetBench {
    std::string bench;
};
struct SetDesignWhite {
    double percentile = kDesignWhitePercentile;
};

struct SetGamutMapping {
    GamutMapping mapping = GamutMapping::strict;
};

using SessionCommand = std::variant<SetPaint,
                                    PaintProduct,
                                    EditPaint,
                                    RenamePaint,
                                    SetArtwork,
                                    AddLook,
                                    DuplicateLook,
                                    RenameLook,
                                    DeleteLook,
                                    MoveLook,
                                    SetLights,
                                    SetEnvironment,
                                    ShareLighting,
                                    SetEye,
                                    SetExposure,
                                    SetQuality,
                                    SetCalibration,
                                    SetBench,
                                    SetDesignWhite,
                                    SetGamutMapping,
                                    SetSeat,
                                    RemoveSeat,
                                    SetSeats,
                                    UseEye>;

/// Files that the command calls a paint by, or that its paint was measured in, and that the
/// document's library has not read: the library is to have them before the command is applied.
std::set<std::filesystem::path> unread_files(const Document& document,
                                             const SessionCommand& command);

/// The document after the command; a pure function. Throws std::invalid_argument with the values
/// (no such look, part, paint, seat; a paint's file that is not read; empty name; not finite; the
/// last look deleted).
Document applied(const Document& document, const SessionCommand& command);

/// A look read from a file as it can stand in a session: what it names beside that file by its
/// whole path, and no file. AddLook takes either.
Look portable_look(Look look);

/// "Paint body solid red", for the undo menu and the log; of the document before it.
std::string label_of(const Document& before, const SessionCommand& command);

/// The look to show after the command, when there is one that it is about.
std::optional<int> look_of(const Document& after, const SessionCommand& command);

/// One line of JSON: {"set-paint": {"look": 1, "part": "body", "paint": "solid red"}}.
std::string text_of(const SessionCommand& command);
/// Throws FileError (as of `origin`) that names the field.
SessionCommand parse_session_command(const std::string& text, const std::string& origin);

}  // namespace livery
