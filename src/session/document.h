// The session as a value: everything that undo brings back.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include <glm/vec3.hpp>

#include "appearance/material_library.h"
#include "scene/frame_plan.h"
#include "scene/gamut_mapping.h"
#include "scene/look.h"
#include "scene/scene.h"
#include "scene/seats.h"

namespace livery {

/// A look with a number that stays its own through renaming, moving, deleting and undo.
struct SessionLook {
    int id = 0;
    Look look;  ///< its exposure is 0 (the session has one), its file is empty
};

struct Document {
    std::string product = "car";             ///< a shipped product's name, or a file
    std::optional<LengthUnit> product_unit;  ///< of the file's numbers, where somebody said
    std::vector<SessionLook> looks;
    int next_look_id = 1;
    std::vector<Material> paints;  ///< the session's own; they come before the library's by name
    glm::dvec3 eye_mm{0.0};        ///< as set by hand; what counts is eye_in_use_mm()
    std::vector<EyeSeat> seats;    ///< of the room, by number
    EyeChoice eye_choice;
    double exposure_ev = 0.0;  ///< the same for all looks
    Quality quality = Quality::normal;
    std::optional<EffectLevels> levels;  ///< of effects one by one; none: the quality's
    std::string bench = "default";       ///< the simulated bench; a shipped name or a file
    std::string calibration;             ///< folder; empty: none, the picture goes out uncorrected
    double design_white_percentile = kDesignWhitePercentile;
    GamutMapping gamut_mapping = GamutMapping::strict;  ///< the same for all looks
    /// What names of paints mean: shared and never changed. Not part of the document's text; null:
    /// no name means anything.
    std::shared_ptr<const PaintLibrary> library;
};

/// How a session names a product: a shipped one as it is, a file by its whole path.
std::string product_reference(const std::string& name_or_file);

/// The shipped looks on a product, seen as the default bench has it, in the library as it is now.
/// Throws FileError.
Document new_document(const std::string& product = "car",
                      std::optional<LengthUnit> unit = std::nullopt);

const SessionLook* find_look(const Document& document, int id);
/// What its names mean: an empty library where it has none.
const PaintLibrary& library_of(const Document& document);
/// The same document where names mean what they do in another library; its own measured paints are
/// those that this one has read.
Document in_library(Document document, std::shared_ptr<const PaintLibrary> library);
/// For a program that runs once: in the library as it is now, with all that the document's paints
/// were measured in and the files that its looks name. Throws FileError.
Document with_paints_read(Document document);

/// The point that looks are shaded for: set by hand, a seat's, or the mean of those that count.
glm::dvec3 eye_in_use_mm(const Document& document);

/// The session's own paint, else the library's.
NamedPaint look_up(const Document& document, const std::string& name);
/// The same. Throws std::invalid_argument where there is none.
Material find_paint(const Document& document, const std::string& name);
/// Of those of its paints, its looks' included, that are not read yet.
std::set<std::filesystem::path> unread_files(const Document& document);
/// A line for each file that drawing needs and that cannot be used now. All stays in the session as
/// it is, and is itself again when the file is back: until then paints are black, pictures are not
/// shown, and a look is lit without its environment.
std::vector<std::string> drawing_problems(const Document& document);
/// The same of one look.
std::vector<std::string> drawing_problems(const Document& document, const SessionLook& look);
/// The session's and the library's names, sorted, each once.
std::vector<std::string> paint_names(const Document& document);

/// What to draw for one look, without what drawing_problems() names. Paints that are not read yet
/// stand in it black (unread_files()). Shares the environment with `loaded` where it is the same.
/// Throws FileError: a part that the product has no longer.
Scene scene_of(const Document& document,
               int look_id,
               std::shared_ptr<const Product> product,
               const std::shared_ptr<const Environment>& loaded = nullptr);

/// One line of JSON with a `format_version`, and back. Throws FileError (as of `origin`) that names
/// the field; a newer version is refused.
std::string text_of(const Document& document);
Document parse_document(const std::string& text, const std::filesystem::path& origin);

}  // namespace livery
