#include "studio/artwork/artwork_edit.h"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>

#include "core/error.h"
#include "scene/artwork_coats.h"
#include "scene/artwork_picture.h"
#include "studio/artwork/artwork_values.h"
#include "studio/paint/parts_panel.h"
#include "studio/paint/swatches.h"
#include "studio/users_library.h"

namespace livery {

namespace {

/// For a print that the part's own paint cannot wear.
constexpr const char* kPlainPaint = "solid white";

/// The paint below an artwork; none for a product file's own colour.
const Material* paint_below(Studio& studio, const std::string& part) {
    const SessionLook* look = find_look(studio.session.document(), studio.shown_look);
    const std::string worn = look ? worn_paint(look->look, part) : "";
    return worn.empty() ? nullptr : paint_named(studio, worn);
}

void tell_refused(Studio& studio, const Artwork& artwork, const std::string& why) {
    tell_error(studio,
               fmt::format("\"{}\" was not changed.", shown_name(artwork)),
               sentence(why),
               "Choose another paint, or another use of the picture.");
}

Artwork placed_at(const Studio& studio, std::size_t at, const PickedPoint& point) {
    const auto part = static_cast<std::size_t>(point.part);
    return put_on(shown_artwork(studio)[at],
                  studio.product->mesh.parts[part].name,
                  point.position_mm,
                  point.normal);
}

}  // namespace

const std::vector<Artwork>& shown_artwork(const Studio& studio) {
    static const std::vector<Artwork> none;
    const SessionLook* look = find_look(studio.session.document(), studio.shown_look);
    return look ? look->look.artwork : none;
}

std::optional<std::size_t> chosen_artwork(const Studio& studio) {
    const ArtworkPanelState& state = studio.panels.of<ArtworkPanelState>();
    const std::size_t count = shown_artwork(studio).size();
    if (count == 0) return std::nullopt;
    if (state.look != studio.shown_look || !state.chosen || *state.chosen >= count) {
        return count - 1;
    }
    return state.chosen;
}

void choose_artwork(Studio& studio, std::optional<std::size_t> at) {
    ArtworkPanelState& state = studio.panels.of<ArtworkPanelState>();
    if (state.look == studio.shown_look && state.chosen == at) return;
    state = {};
    state.look = studio.shown_look;
    state.chosen = at;
}

std::string wearing_problem(Studio& studio, const Artwork& artwork) {
    const bool asks_something_of_it = artwork.paint.empty() &&
                                      artwork.shape == ArtworkShape::picture &&
                                      artwork.use != PictureUse::cover && !is_relief(artwork);
    if (!asks_something_of_it || !studio.product) return "";
    try {
        const auto picture = load_artwork_picture(find_artwork_picture(artwork.picture, {}));
        for (const Part& part : studio.product->mesh.parts) {
            if (artwork.part != "*" && artwork.part != part.name) continue;
            const Material* below = paint_below(studio, part.name);
            if (!below && part.paint) below = &*part.paint;
            if (below) make_part_artwork(0, artwork, *below, picture);
        }
    } catch (const std::invalid_argument& error) {
        return error.what();
    } catch (const FileError&) {
        return "";  // The command names what is wrong with the file.
    }
    return "";
}

namespace {

/// Whether an artwork below it may lie between it and the part's paint.
bool lies_over_another(const std::vector<Artwork>& list, std::size_t at) {
    return std::any_of(
        list.begin(), list.begin() + static_cast<std::ptrdiff_t>(at), [&](const Artwork& below) {
            return !is_relief(below) &&
                   (below.part == "*" || list[at].part == "*" || below.part == list[at].part);
        });
}

std::string look_up_why_not_seen(Studio& studio, std::size_t at) {
    const Artwork& artwork = shown_artwork(studio).at(at);
    if (const auto problem = picture_problem(artwork)) return "Not shown: " + *problem;
    if (const std::string problem = wearing_problem(studio, artwork); !problem.empty()) {
        return "Left out where the paint below cannot wear it: " + problem + ".";
    }
    const bool own_colours =
        artwork.shape == ArtworkShape::picture && artwork.use != PictureUse::cover;
    const SessionLook* look = find_look(studio.session.document(), studio.shown_look);
    if (own_colours || !look || !studio.product) return "";
    if (lies_over_another(shown_artwork(studio), at)) return "";
    for (const Part& part : studio.product->mesh.parts) {
        if (artwork.part != "*" && artwork.part != part.name) continue;
        const std::string below = worn_paint(look->look, part.name);
        if (!artwork.paint.empty() && artwork.paint != below) return "";
    }
    return "Not to be seen: it has the paint that lies below it. Choose another paint.";
}

}  // namespace

const std::string& why_not_seen(Studio& studio, std::size_t at) {
    ArtworkPanelState& state = studio.panels.of<ArtworkPanelState>();
    const std::vector<Artwork>& list = shown_artwork(studio);
    if (state.looked_up_at != studio.session.revision() || state.not_seen.size() != list.size()) {
        state.looked_up_at = studio.session.revision();
        state.not_seen.clear();
        for (std::size_t k = 0; k < list.size(); ++k) {
            state.not_seen.push_back(look_up_why_not_seen(studio, k));
        }
    }
    return state.not_seen.at(at);
}

SetArtwork artwork_command(const Studio& studio, std::size_t at, const Artwork& artwork) {
    SetArtwork command{studio.shown_look, shown_artwork(studio)};
    command.artwork.at(at) = artwork;
    return command;
}

void set_artwork(Studio& studio,
                 const std::vector<Artwork>& list,
                 std::optional<std::size_t> chosen) {
    const std::uint64_t before = studio.session.revision();
    commit(studio, SetArtwork{studio.shown_look, list});
    if (studio.session.revision() != before) choose_artwork(studio, chosen);
}

void set_artwork_at(Studio& studio, std::size_t at, const Artwork& artwork) {
    if (artwork == shown_artwork(studio).at(at)) return;
    const std::string why = wearing_problem(studio, artwork);
    if (!why.empty()) return tell_refused(studio, artwork, why);
    set_artwork(studio, artwork_command(studio, at, artwork).artwork, at);
}

Artwork artwork_to_add(Studio& studio, ArtworkShape shape, const std::filesystem::path& picture) {
    const auto chosen = chosen_part(studio);
    const Mesh& mesh = studio.product->mesh;
    const std::string part = chosen ? mesh.parts[*chosen].name : "*";
    const double aspect = picture.empty() ? 1.0 : load_artwork_picture(picture)->aspect();
    Artwork artwork = new_artwork(shape,
                                  part,
                                  bounds_of_part(mesh, part),
                                  eye_in_use_mm(studio.session.document()),
                                  shown_artwork(studio),
                                  aspect);
    if (shape == ArtworkShape::picture) {
        artwork.picture = picture.string();
        if (!wearing_problem(studio, artwork).empty()) artwork.paint = kPlainPaint;
        return artwork;
    }
    const Material* below = paint_below(studio, part);
    artwork.paint = paint_over(below ? drawn_face_lab(*below).x : 50.0);
    return artwork;
}

void add_artwork(Studio& studio, ArtworkShape shape) {
    const auto add = [&studio](const Artwork& artwork) {
        std::vector<Artwork> list = shown_artwork(studio);
        list.push_back(artwork);
        set_artwork(studio, list, list.size() - 1);
    };
    if (shape != ArtworkShape::picture) return add(artwork_to_add(studio, shape));
    ask_for_picture(studio, "Add a picture", {}, [&studio, add](const auto& file) {
        add(artwork_to_add(studio, ArtworkShape::picture, file));
    });
}

void ask_for_picture(Studio& studio,
                     const std::string& title,
                     const std::filesystem::path& start,
                     std::function<void(const std::filesystem::path&)> then) {
    studio.file_dialog->ask(
        {.kind = FileQuestion::Kind::open,
         .title = title,
         .action = "Open",
         .suffixes = {".png", ".jpg", ".jpeg", ".tif", ".tiff", ".exr"},
         .suggested = start.empty() ? pictures_folder() : start,
         .then = [&studio, then = std::move(then)](const std::filesystem::path& file) {
             try {
                 load_artwork_picture(file);
                 then(file);
             } catch (const FileError& error) {
                 tell_error(studio,
                            "The picture was not taken.",
                            error.what(),
                            "Choose another file: PNG, JPEG, TIFF or EXR.");
             }
         }});
}

bool is_placing(const Studio& studio) {
    return studio.panels.of<ArtworkPanelState>().placing && chosen_artwork(studio).has_value() &&
           studio.panels.of<ArtworkPanelState>().look == studio.shown_look;
}

void stop_placing(Studio& studio) {
    studio.panels.of<ArtworkPanelState>().placing = false;
    studio.panels.of<ArtworkPanelState>().placed.reset();
}

void try_placing(Studio& studio, const std::optional<PickedPoint>& point) {
    ArtworkPanelState& state = studio.panels.of<ArtworkPanelState>();
    const std::size_t at = *chosen_artwork(studio);
    if (point) state.placed = placed_at(studio, at, *point);
    if (state.placed && wearing_problem(studio, *state.placed).empty()) {
        try_held(studio, artwork_command(studio, at, *state.placed));
    }
}

void place(Studio& studio, const PickedPoint& point) {
    const std::size_t at = *chosen_artwork(studio);
    const Artwork placed = placed_at(studio, at, point);
    stop_placing(studio);
    set_artwork_at(studio, at, placed);
}

}  // namespace livery
