#include "session/session.h"

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <string>

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include "core/error.h"
#include "core/log.h"
#include "core/paths.h"
#include "session/session_file.h"

namespace livery {

namespace {

/// Holds `FILE.lock` beside a file; the system lets go of it when the program ends, however it
/// ends.
class FileLock {
  public:
    /// Throws Refused when another holds it (`what` begins the message, the holder's process ends
    /// it; with the fix), FileError when the folder cannot be written.
    FileLock(const std::filesystem::path& file, const std::string& what, const std::string& fix);
    ~FileLock();
    FileLock(const FileLock&) = delete;
    FileLock& operator=(const FileLock&) = delete;

  private:
    std::filesystem::path lock_file_;
    int descriptor_ = -1;
};

/// The process that wrote itself into the lock file; empty while it has not yet.
std::string holder_of(int descriptor) {
    char text[32] = {};
    const ssize_t size = ::pread(descriptor, text, sizeof text - 1, 0);
    std::string process(text, static_cast<std::size_t>(std::max<ssize_t>(size, 0)));
    const auto is_digit = [](unsigned char c) { return std::isdigit(c) != 0; };
    process.erase(std::find_if_not(process.begin(), process.end(), is_digit), process.end());
    return process;
}

/// Whether the name still leads to the file that was opened: its last holder removes it.
bool is_still_there(int descriptor, const std::filesystem::path& file) {
    struct stat opened {
    }, named{};
    return ::fstat(descriptor, &opened) == 0 && ::stat(file.c_str(), &named) == 0 &&
           opened.st_ino == named.st_ino && opened.st_dev == named.st_dev;
}

FileLock::FileLock(const std::filesystem::path& file,
                   const std::string& what,
                   const std::string& fix) {
    std::error_code unknown;
    lock_file_ = std::filesystem::weakly_canonical(file, unknown);
    if (unknown) lock_file_ = std::filesystem::absolute(file);
    lock_file_ += ".lock";
    while (true) {
        descriptor_ = ::open(lock_file_.c_str(), O_RDWR | O_CREAT | O_NOFOLLOW | O_CLOEXEC, 0644);
        if (descriptor_ < 0) {
            throw FileError(file,
                            "",
                            "no way to write beside it (" + std::string(std::strerror(errno)) + ")",
                            "a folder that is there and that you may write");
        }
        if (::flock(descriptor_, LOCK_EX | LOCK_NB) != 0) {
            const std::string process = holder_of(descriptor_);
            ::close(descriptor_);
            throw Refused(what + (process.empty() ? "" : " (process " + process + ")"), fix);
        }
        if (is_still_there(descriptor_, lock_file_)) break;
        ::close(descriptor_);
    }
    // Only for the message: on a full disk the lock holds all the same.
    const std::string process = std::to_string(::getpid()) + "\n";
    if (::ftruncate(descriptor_, 0) == 0) {
        [[maybe_unused]] const ssize_t written =
            ::pwrite(descriptor_, process.data(), process.size(), 0);
    }
}

FileLock::~FileLock() {
    ::unlink(lock_file_.c_str());
    ::close(descriptor_);
}

}  // namespace

// Steps 0 to `saved_last` lie in the file, those behind them wait in `unsaved`: none, as long as
// saving works. Without a file all wait.
struct Session::State {
    std::unique_ptr<FileLock> lock;  ///< let go of after the file is closed
    std::unique_ptr<SessionFile> store;
    std::filesystem::path path;

    Document document;
    std::uint64_t revision = 0;
    std::int64_t position = 0;
    std::int64_t saved_last = -1;
    std::vector<SessionStep> unsaved;
    Workspace workspace, unsaved_workspace;
    std::optional<std::string> problem;
    std::string undo_label, redo_label;

    State() = default;
    State(const State&) = delete;
    State& operator=(const State&) = delete;
    ~State() {
        if (problem) save();
    }

    std::int64_t last() const { return saved_last + static_cast<std::int64_t>(unsaved.size()); }

    SessionStep step(std::int64_t number) const {
        if (number <= saved_last) return store->step(number);
        return unsaved[static_cast<std::size_t>(number - saved_last - 1)];
    }

    Document document_at(std::int64_t number) const {
        if (number <= saved_last) return store->document(number);
        return parse_document(step(number).document, "unsaved session");
    }

    /// Goes to that step; when it cannot be read nothing changes.
    void stand_at(std::int64_t number) {
        Document there = document_at(number);
        std::string undo = number > 0 ? step(number).label : "";
        std::string redo = number < last() ? step(number + 1).label : "";
        document = in_library(std::move(there), document.library);
        undo_label = std::move(undo);
        redo_label = std::move(redo);
        position = number;
    }

    /// What cannot be saved now goes along with the next that can.
    void save() {
        if (!store) return;
        try {
            store->save(saved_last, unsaved, position, unsaved_workspace);
        } catch (const FileError& failure) {
            if (!problem) log_line(LogLevel::error, std::string("not saved: ") + failure.what());
            problem = failure.what();
            return;
        }
        if (problem) log_line(LogLevel::info, "saved again: " + path.string());
        problem.reset();
        saved_last = last();
        unsaved.clear();
        unsaved_workspace.clear();
    }

    void add(SessionStep added, Document after) {
        if (position < saved_last) {
            // Kept in the file until the transaction that also adds the new step.
            saved_last = position;
            unsaved.clear();
        } else {
            unsaved.resize(static_cast<std::size_t>(position - saved_last));
        }
        undo_label = added.label;
        redo_label.clear();
        unsaved.push_back(std::move(added));
        document = std::move(after);
        ++position;
        ++revision;
        save();
    }

    /// To the step before (-1) or after (+1). Returns the look that `command`, the one taken back
    /// or done again, was about.
    std::optional<int> go(std::int64_t by) {
        const std::int64_t about = by < 0 ? position : position + 1;
        const SessionCommand command = parse_session_command(step(about).command, path.string());
        stand_at(position + by);
        ++revision;
        save();
        const bool made_one = std::holds_alternative<AddLook>(command) ||
                              std::holds_alternative<DuplicateLook>(command);
        if (by < 0 && made_one) return std::nullopt;
        return look_of(document, command);
    }
};

namespace {

std::unique_ptr<FileLock> lock_of(const std::filesystem::path& file) {
    return std::make_unique<FileLock>(file,
                                      file.string() + " is open in another Livery",
                                      "close it there, or name another session file here");
}

/// Whether this is the session in the user's folder, whose folder may not be there yet.
bool is_default(const std::filesystem::path& file) {
    try {
        return file == default_session_file();
    } catch (const FileError&) {
        return false;  // no user's folder, and so not in it
    }
}

}  // namespace

Session::Session(std::unique_ptr<State> state) : state_(std::move(state)) {}
Session::Session(Session&&) noexcept = default;
Session& Session::operator=(Session&&) noexcept = default;

Session::~Session() = default;

Session Session::open(const std::filesystem::path& file,
                      const std::string& product,
                      std::optional<LengthUnit> unit) {
    auto state = std::make_unique<State>();
    if (is_default(file)) make_output_folder(file.parent_path());
    state->path = file;
    state->lock = lock_of(file);
    std::error_code error;
    if (!std::filesystem::exists(file, error)) {
        SessionFile::create(file, {{"", "", text_of(new_document(product, unit))}});
    }
    state->store = std::make_unique<SessionFile>(file, SessionFile::Access::change);
    state->store->check_pages();
    state->saved_last = state->store->last_step();
    state->workspace = state->store->workspace();
    state->document.library = read_paint_library();
    state->stand_at(state->store->position());
    return Session(std::move(state));
}

Session Session::unsaved(const Document& document, std::string why) {
    auto state = std::make_unique<State>();
    state->unsaved = {{"", "", text_of(document)}};
    state->document = document;
    state->problem = std::move(why);
    return Session(std::move(state));
}

const Document& Session::document() const { return state_->document; }
std::uint64_t Session::revision() const { return state_->revision; }

void Session::use(std::shared_ptr<const PaintLibrary> library) {
    if (library == state_->document.library) return;
    state_->document = in_library(std::move(state_->document), std::move(library));
    ++state_->revision;
}

void Session::execute(const SessionCommand& command) {
    Document after = applied(state_->document, command);
    std::string text = text_of(after);
    // A step back that changes nothing would only puzzle.
    if (text == text_of(state_->document)) return;
    state_->add({text_of(command), label_of(state_->document, command), std::move(text)},
                std::move(after));
}

bool Session::can_undo() const { return state_->position > 0; }
bool Session::can_redo() const { return state_->position < state_->last(); }
std::string Session::undo_label() const { return state_->undo_label; }
std::string Session::redo_label() const { return state_->redo_label; }

std::optional<int> Session::undo() { return can_undo() ? state_->go(-1) : std::nullopt; }
std::optional<int> Session::redo() { return can_redo() ? state_->go(+1) : std::nullopt; }

const Workspace& Session::workspace() const { return state_->workspace; }

void Session::set_workspace(const std::string& name, const std::string& value) {
    const auto known = state_->workspace.find(name);
    if (known != state_->workspace.end() && known->second == value) return;
    state_->workspace[name] = value;
    state_->unsaved_workspace[name] = value;
    state_->save();
}

void Session::save_as(const std::filesystem::path& file) {
    std::error_code error;
    if (std::filesystem::exists(file, error)) {
        throw Refused(file.string() + " is there already",
                      "choose another name; a session is never written over");
    }
    auto lock = lock_of(file);
    std::vector<SessionStep> steps;
    for (std::int64_t number = 0; number <= state_->last(); ++number) {
        steps.push_back(state_->step(number));
    }
    SessionFile::create(file, steps, state_->position, state_->workspace);
    auto store = std::make_unique<SessionFile>(file, SessionFile::Access::change);
    state_->store = std::move(store);
    state_->lock = std::move(lock);
    state_->path = file;
    state_->saved_last = state_->last();
    state_->unsaved.clear();
    state_->unsaved_workspace.clear();
    state_->problem.reset();
    log_line(LogLevel::info, "the session is saved in " + file.string());
}

std::optional<std::string> Session::save_problem() const { return state_->problem; }

bool Session::save_again() {
    if (state_->problem) state_->save();
    return !state_->problem;
}

std::optional<std::filesystem::path> Session::file() const {
    return state_->store ? std::optional(state_->path) : std::nullopt;
}

std::filesystem::path default_session_file() {
    return user_folder() / "sessions" / "default.livery";
}

}  // namespace livery
