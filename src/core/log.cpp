#include "core/log.h"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <mutex>
#include <string>

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include "core/error.h"
#include "core/time.h"

namespace livery {

namespace {

const char* level_name(LogLevel level) {
    switch (level) {
        case LogLevel::info:
            return "info";
        case LogLevel::warning:
            return "warning";
        case LogLevel::error:
            return "error";
    }
    return "?";
}

/// The time, the level, and the text as one line: a control character could forge another one.
std::string log_text(LogLevel level, std::string_view text) {
    std::string line = utc_now_ms() + ' ' + level_name(level) + ' ';
    for (const char c : text) {
        const auto code = static_cast<unsigned char>(c);
        line += code < 0x20 || code == 0x7f ? ' ' : c;
    }
    return line + '\n';
}

/// One open log. Any number of programs may append to the same file and rotate it.
class Log {
  public:
    void open(const std::filesystem::path& file, std::size_t max_bytes, int kept) {
        const std::lock_guard lock(mutex_);
        close();
        file_ = file;
        max_bytes_ = max_bytes;
        kept_ = kept;
        complained_ = cut_off_ = false;
        if (!ready_for(0)) complain();
    }

    void write(LogLevel level, std::string_view text) {
        const std::lock_guard lock(mutex_);
        if (file_.empty()) return;
        std::string line = log_text(level, text);
        if (!ready_for(line.size()) || !append(line)) complain();
    }

  private:
    void close() {
        if (descriptor_ >= 0) ::close(descriptor_);
        descriptor_ = -1;
    }

    /// Opens the file when it is not open, or when another program has rotated it.
    bool reopen() {
        struct stat opened {};
        struct stat named {};
        const bool same = descriptor_ >= 0 && ::fstat(descriptor_, &opened) == 0 &&
                          ::stat(file_.c_str(), &named) == 0 && opened.st_dev == named.st_dev &&
                          opened.st_ino == named.st_ino;
        if (same) return true;
        close();
        std::error_code error;
        if (file_.has_parent_path()) {
            std::filesystem::create_directories(file_.parent_path(), error);
        }
        if (error) {
            errno = error.value();
            return false;
        }
        // Without O_NONBLOCK a pipe that nobody reads would stop the program here.
        descriptor_ =
            ::open(file_.c_str(), O_WRONLY | O_APPEND | O_CREAT | O_CLOEXEC | O_NONBLOCK, 0666);
        return descriptor_ >= 0;
    }

    std::filesystem::path numbered(int number) const {
        auto file = file_;
        return file += "." + std::to_string(number);
    }

    /// Opened, and rotated when `bytes` more would be too many.
    bool ready_for(std::size_t bytes) {
        if (!reopen()) return false;
        struct stat opened {};
        if (::fstat(descriptor_, &opened) != 0) return false;
        const auto size = static_cast<std::size_t>(opened.st_size);
        if (!S_ISREG(opened.st_mode) || size == 0 || size + bytes <= max_bytes_) return true;
        // Another program is rotating right now: this line still belongs to the old file.
        if (::flock(descriptor_, LOCK_EX | LOCK_NB) != 0) return errno == EWOULDBLOCK;
        // Between looking and locking another program may have done it.
        struct stat named {};
        const bool ours = ::stat(file_.c_str(), &named) == 0 && named.st_ino == opened.st_ino &&
                          named.st_dev == opened.st_dev;
        const bool rotated = !ours || rotate();
        const int reason = errno;
        if (descriptor_ >= 0) ::flock(descriptor_, LOCK_UN);
        errno = reason;
        return rotated && reopen();
    }

    bool rotate() const {
        if (kept_ == 0) return ::unlink(file_.c_str()) == 0;
        for (int number = kept_; number > 1; --number) {
            const bool moved =
                ::rename(numbered(number - 1).c_str(), numbered(number).c_str()) == 0;
            if (!moved && errno != ENOENT) return false;
        }
        return ::rename(file_.c_str(), numbered(1).c_str()) == 0;
    }

    bool append(std::string line) {
        // The disk filled up in the middle of the last line.
        if (cut_off_) line.insert(line.begin(), '\n');
        std::string_view rest = line;
        while (!rest.empty()) {
            const auto written = ::write(descriptor_, rest.data(), rest.size());
            if (written < 0 && errno == EINTR) continue;
            if (written <= 0) {
                cut_off_ = cut_off_ || rest.size() < line.size();
                return false;
            }
            rest.remove_prefix(static_cast<std::size_t>(written));
        }
        cut_off_ = false;
        return true;
    }

    void complain() {
        if (complained_) return;
        complained_ = true;
        const std::string text = "livery: the log " + file_.string() +
                                 " cannot be written: " + std::strerror(errno) +
                                 "; going on without it\n";
        std::fputs(text.c_str(), stderr);
    }

    std::mutex mutex_;
    std::filesystem::path file_;
    std::size_t max_bytes_ = 0;
    int kept_ = 0;
    int descriptor_ = -1;
    bool complained_ = false;
    bool cut_off_ = false;  ///< the file ends within a line
};

/// Never destroyed: threads may still log while the program ends.
Log& the_log() {
    static Log& log = *new Log;
    return log;
}

}  // namespace

void open_log(const std::filesystem::path& file, std::size_t max_bytes, int kept) {
    check_argument(!file.empty() && max_bytes > 0 && kept >= 0,
                   "open_log: file \"" + file.string() + "\", " + std::to_string(max_bytes) +
                       " bytes, " + std::to_string(kept) +
                       " kept; expected a name, at least 1 byte and 0 kept");
    the_log().open(file, max_bytes, kept);
}

void log_line(LogLevel level, std::string_view text) { the_log().write(level, text); }

}  // namespace livery
