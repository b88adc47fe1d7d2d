// The page that makes a session of a product of one's own: a mesh is read, a few questions are
// asked once with what they come to in millimetres, and a product file is written beside the
// session. And another session in the same window: opened, dropped on it, or one of the last.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <glm/vec2.hpp>

#include "gl/handles.h"
#include "session/session.h"
#include "studio/kit/user_settings.h"
#include "studio/product/mesh_picture.h"
#include "studio/product/product_answers.h"

namespace livery {

struct Studio;

/// A session and what it shows, ready for a window.
struct OpenedSession {
    Session session;
    std::shared_ptr<const Product> product;
};

/// What a picture of the mesh shows.
struct MeshPictureKey {
    UpAxis up = UpAxis::plus_y;
    int quarter_turns = 0;
    double azimuth_rad = 0.0;
    glm::ivec2 size_px{0};
    bool operator==(const MeshPictureKey&) const = default;
};

struct NewSession {
    enum class Stage { reading, unreadable, asking, creating };
    Stage stage = Stage::reading;
    std::filesystem::path given;     ///< a mesh, or a product file
    std::optional<LengthUnit> unit;  ///< said with it
    std::uint64_t number = 0;        ///< what was asked for another page is not for this one
    std::string problem;             ///< why there is no session yet; empty: nobody tried

    std::shared_ptr<const Mesh> mesh;  ///< shared with the thread that draws its picture
    MeshFacts facts;
    std::vector<MeshSample> samples;  ///< of the mesh, in its numbers
    View projector;                   ///< of the bench that new sessions have
    SuggestedAnswers suggested;
    ProductAnswers answers;
    bool is_product_file = false;   ///< it says all itself
    std::filesystem::path session;  ///< the file to be made
    bool other_scale = false;       ///< typed, not one of the usual

    bool to_open = true;
    double azimuth_rad = kThreeQuarters_rad;  ///< from where the picture is seen
    std::optional<MeshPictureKey> pictured;   ///< what the picture shows, or will
    bool picturing = false;                   ///< the next is asked for when this one is there
    Texture2D picture;
};

struct NewSessionPage {
    std::unique_ptr<NewSession> open;    ///< none: closed
    std::unique_ptr<NewSession> closed;  ///< its picture may be in this frame's drawing
    std::uint64_t pages = 0;             ///< opened so far
};
std::unique_ptr<NewSession>& page(Studio& studio);

/// What `livery desktop FILE` and the dialogs take as a product.
bool is_product_path(const std::filesystem::path& file);

/// `folder`/NAME.livery, with a number where there is such a session or its product file.
std::filesystem::path unused_session_file(const std::filesystem::path& folder,
                                          const std::string& name);
/// Where the product of a session made in the window lies: NAME.product.json beside NAME.livery.
std::filesystem::path product_file_beside(const std::filesystem::path& session);

/// Makes the session and, for a mesh, its product file. Throws Refused where one of them is there
/// already, FileError; then neither was made.
OpenedSession create_session(const NewSession& asked);

/// Opens the page with a mesh or product file, which is read in the background. Without a file for
/// the session one is suggested, in the user's folder. A unit is that of the file's numbers,
/// whatever the file says.
void begin_new_session(Studio& studio,
                       const std::filesystem::path& file,
                       const std::filesystem::path& session = {},
                       std::optional<LengthUnit> unit = {});
/// Asks for the file by the dialog first.
void ask_for_product(Studio& studio);
void draw_new_session(Studio& studio);  ///< once a frame

// What the page asks for.
/// Makes the session in the background; the window then goes on with it.
void start_creating(Studio& studio);
/// The mesh as it would stand; drawn in the background when it has changed.
void ask_for_mesh_picture(Studio& studio, glm::ivec2 size_px);

/// Opens it in the background; the window then goes on with it. Where it cannot be opened a notice
/// says why and the session that is open stays; one that another start has open has its window
/// asked for.
void open_other_session(Studio& studio, const std::filesystem::path& file);
/// Asks for the file first.
void ask_for_session(Studio& studio);

/// What came from another program: a session opens, a mesh or product file begins a new session,
/// for anything else a notice says what can be dropped.
void take_dropped_files(Studio& studio, const std::vector<std::filesystem::path>& files);

/// Why another session may not take this one's place: something in it is on no disk. A sentence;
/// empty: it may.
std::string why_not_to_leave(const Studio& studio);

/// Leaves the session by `then`, in words `doing` ("Opening car.livery") and on a button `action`
/// ("Stop and open"). A calibration or a capture that this would stop is asked about first.
void leave_session(Studio& studio,
                   const std::string& doing,
                   const std::string& action,
                   std::function<void()> then);

/// The newest first.
std::vector<std::filesystem::path> recent_sessions(const UserSettings& settings);
void remember_recent_session(UserSettings& settings, const std::filesystem::path& file);
inline constexpr std::size_t kMostRecentSessions = 10;

}  // namespace livery
