#include "studio/product/new_session.h"

#include "core/error.h"
#include "core/paths.h"
#include "live/projector_setup.h"
#include "scene/library.h"
#include "studio/studio.h"

namespace livery {

namespace {

/// What was read of a file, on the way to the page.
struct Read {
    Mesh mesh;
    MeshFacts facts;
    SuggestedAnswers suggested;
    std::vector<MeshSample> samples;
    View projector;
    bool is_product_file = false;
};

Read read_given(const std::filesystem::path& file, std::optional<LengthUnit> unit) {
    Read read;
    read.projector = uncorrected_setup(Document{}.bench)->view;
    read.is_product_file = has_suffix_of(file, {".json"});
    if (read.is_product_file) {
        Product product = load_product(file, unit);
        read.mesh = std::move(product.mesh);
        read.facts = facts_of(read.mesh, file);
        read.samples = mesh_samples(read.mesh);
        read.suggested.answers.mesh_is_product = false;
        read.suggested.answers.product_scale = product.product_scale;
        read.suggested.answers.part_names = read.facts.parts;
        return read;
    }
    read.mesh = load_mesh(file, nullptr, LengthUnit::mm);
    read.facts = facts_of(read.mesh, file);
    read.samples = mesh_samples(read.mesh);
    read.suggested = suggested_answers(read.facts, unit);
    return read;
}

bool is_there(const std::filesystem::path& file) {
    std::error_code error;
    return std::filesystem::exists(file, error);
}

/// The page that asked, if it is still open.
NewSession* page_of(Studio& studio, std::uint64_t number) {
    const bool still_open = page(studio) && page(studio)->number == number;
    return still_open ? page(studio).get() : nullptr;
}

/// In the background, as answered.
void create(Studio& studio, NewSession& asked) {
    asked.stage = NewSession::Stage::creating;
    const auto answered = std::make_shared<NewSession>();
    answered->given = asked.given;
    answered->unit = asked.unit;
    answered->facts = asked.facts;
    answered->answers = asked.answers;
    answered->is_product_file = asked.is_product_file;
    answered->session = asked.session;
    studio.background->run(
        [&studio, answered](const Progress&) -> Background::Then {
            const auto opened = std::make_shared<OpenedSession>(create_session(*answered));
            return [&studio, opened] { studio.next_session = opened; };
        },
        [&studio, number = asked.number](const std::exception_ptr& why) {
            NewSession* page = page_of(studio, number);
            if (!page) return notify_failure(studio, "The session was not made.", why);
            page->stage = NewSession::Stage::asking;
            page->problem = in_words(why);
        });
}

}  // namespace

std::unique_ptr<NewSession>& page(Studio& studio) {
    return studio.panels.of<NewSessionPage>().open;
}

bool is_product_path(const std::filesystem::path& file) {
    return has_suffix_of(file, {".glb", ".gltf", ".ply", ".obj", ".json"});
}

std::filesystem::path product_file_beside(const std::filesystem::path& session) {
    return std::filesystem::path(session).replace_extension(".product.json");
}

std::filesystem::path unused_session_file(const std::filesystem::path& folder,
                                          const std::string& name) {
    for (int k = 1;; ++k) {
        const std::string number = k == 1 ? "" : "-" + std::to_string(k);
        const auto file = folder / (name + number + ".livery");
        if (!is_there(file) && !is_there(product_file_beside(file))) return file;
    }
}

OpenedSession create_session(const NewSession& asked) {
    const auto product_file =
        asked.is_product_file ? asked.given : product_file_beside(asked.session);
    const auto refuse_if_there = [](const std::filesystem::path& file) {
        if (!is_there(file)) return;
        throw Refused(file.string() + " is there already",
                      "choose another name; nothing is written over");
    };
    refuse_if_there(asked.session);
    make_output_folder(asked.session.parent_path());
    if (!asked.is_product_file) {
        refuse_if_there(product_file);
        const std::string name = asked.session.stem().string();
        write_text_file(product_file,
                        text_of(product_file_of(asked.facts, asked.answers, name), product_file));
    }
    try {
        const auto unit = asked.is_product_file ? asked.unit : std::nullopt;
        auto product = find_product(product_file.string(), unit);
        return {Session::open(asked.session, product_file.string(), unit), std::move(product)};
    } catch (...) {
        std::error_code error;
        if (!asked.is_product_file) std::filesystem::remove(product_file, error);
        throw;
    }
}

void begin_new_session(Studio& studio,
                       const std::filesystem::path& file,
                       const std::filesystem::path& session,
                       std::optional<LengthUnit> unit) {
    const std::uint64_t number = ++studio.panels.of<NewSessionPage>().pages;
    if (page(studio)) studio.panels.of<NewSessionPage>().closed = std::move(page(studio));
    page(studio) = std::make_unique<NewSession>();
    page(studio)->number = number;
    page(studio)->given = std::filesystem::absolute(file).lexically_normal();
    page(studio)->unit = unit;
    if (!session.empty()) page(studio)->session = std::filesystem::absolute(session);
    const auto its_page = [&studio, number] { return page_of(studio, number); };
    studio.background->run(
        [its_page, given = page(studio)->given, unit](const Progress&) -> Background::Then {
            const auto read = std::make_shared<Read>(read_given(given, unit));
            return [its_page, read] {
                NewSession* asked = its_page();
                if (!asked) return;
                asked->facts = std::move(read->facts);
                asked->suggested = std::move(read->suggested);
                asked->samples = std::move(read->samples);
                asked->projector = read->projector;
                asked->answers = asked->suggested.answers;
                asked->mesh = std::make_shared<const Mesh>(std::move(read->mesh));
                asked->is_product_file = read->is_product_file;
                asked->stage = NewSession::Stage::asking;
                if (!asked->session.empty()) return;
                std::string name = asked->given.stem().string();
                if (name.ends_with(".product")) name.resize(name.size() - 8);
                asked->session =
                    unused_session_file(default_session_file().parent_path(), file_name_of(name));
            };
        },
        [its_page](const std::exception_ptr& why) {
            NewSession* asked = its_page();
            if (!asked) return;
            asked->stage = NewSession::Stage::unreadable;
            asked->problem = in_words(why);
        });
}

void ask_for_product(Studio& studio) {
    studio.file_dialog->ask(
        {.title = "New session",
         .action = "Next",
         .suffixes = {".glb", ".gltf", ".ply", ".obj", ".json"},
         .suggested = documents_folder(),
         .then = [&studio](const auto& file) { begin_new_session(studio, file); }});
}

void start_creating(Studio& studio) {
    NewSession& asked = *page(studio);
    asked.problem = asked.is_product_file ? "" : problem_of(asked.answers);
    asked.session = typed_path(asked.session.string(), default_session_file().parent_path());
    if (asked.session.empty()) {
        asked.problem = "Say where the session is saved.";
    } else if (asked.session.extension() != ".livery") {
        asked.session += ".livery";
    }
    if (asked.problem.empty()) asked.problem = why_not_to_leave(studio);
    if (!asked.problem.empty()) return;
    const std::string doing = "Making " + asked.session.filename().string();
    leave_session(studio, doing, "Stop and create", [&studio, number = asked.number] {
        if (NewSession* page = page_of(studio, number)) create(studio, *page);
    });
}

void ask_for_mesh_picture(Studio& studio, glm::ivec2 size_px) {
    NewSession& asked = *page(studio);
    const MeshPictureKey wanted{
        asked.answers.up, asked.answers.quarter_turns, asked.azimuth_rad, size_px};
    if (asked.pictured == wanted || asked.picturing || !asked.mesh) return;
    asked.pictured = wanted;
    asked.picturing = true;
    studio.background->run(
        [&studio, mesh = asked.mesh, wanted, number = asked.number](
            const Progress&) -> Background::Then {
            const auto picture = std::make_shared<const Image8>(
                mesh_picture(*mesh,
                             upright_rotation(wanted.up, wanted.quarter_turns),
                             wanted.size_px,
                             wanted.azimuth_rad));
            return [&studio, picture, number] {
                NewSession* page = page_of(studio, number);
                if (!page) return;
                page->picturing = false;
                page->picture = texture_of(*picture);
            };
        },
        [&studio, number = asked.number](const std::exception_ptr& why) {
            if (NewSession* page = page_of(studio, number)) page->picturing = false;
            notify_failure(studio, "The mesh's picture could not be drawn.", why);
        });
}

}  // namespace livery
