// Files and folders that are replaced whole or not at all, also when the power goes.
#pragma once

#include <filesystem>
#include <string>

namespace livery {

/// Makes a rename in a folder last. What cannot be flushed (a file system without folders of its
/// own) stays as it is.
void sync_folder(const std::filesystem::path& folder);

/// A folder's new content, written beside it. Until commit() the old one is as it was; without it
/// the new one is gone with the object.
class FolderReplacement {
  public:
    /// Throws FileError.
    explicit FolderReplacement(const std::filesystem::path& folder);
    ~FolderReplacement();
    FolderReplacement(const FolderReplacement&) = delete;
    FolderReplacement& operator=(const FolderReplacement&) = delete;

    /// Where the new files are written.
    const std::filesystem::path& staging() const { return staging_; }

    /// Puts the new folder into the old one's place at once; the few other files that lie in the
    /// old one are taken along. Where that cannot be done at once (a folder with folders in it, the
    /// one that the program runs in, a mount point, a file system that cannot exchange), file by
    /// file, `last` at the end. Throws FileError.
    void commit(const std::string& last);

  private:
    bool exchange();
    void move_files(const std::string& last);

    std::filesystem::path folder_, staging_;
};

}  // namespace livery
