// A report as HTML and as PDF: all figures, whatever the names hold, and nothing from elsewhere.

#include <regex>
#include <string>

#include <gtest/gtest.h>
#include <zlib.h>

#include "evaluation/report/report_document.h"
#include "evaluation/report/sample_votes.h"

namespace livery {
namespace {

const std::vector<std::string> kHostile = {"<script>alert(1)</script> & \"co\"",
                                           "赤いメタリック 🚗",
                                           "أحمر معدني",
                                           std::string("a\nb\tc\x01\xff") + std::string(90, 'W')};

std::size_t count_of(const std::string& text, const std::string& part) {
    std::size_t count = 0;
    for (std::size_t at = 0; (at = text.find(part, at)) != std::string::npos; ++at) ++count;
    return count;
}

/// A PDF file's objects: the file, and after it what its compressed streams hold. Cairo from 1.18
/// on packs objects into such streams.
std::string objects_of(const std::string& pdf) {
    std::string objects = pdf;
    const std::string begins = "stream\n", ends = "\nendstream";
    std::size_t at = 0;
    while ((at = pdf.find(begins, at)) != std::string::npos) {
        at += begins.size();
        const std::size_t end = pdf.find(ends, at);
        if (end == std::string::npos) break;
        std::string held(std::size_t{1} << 24u, '\0');
        uLongf size = held.size();
        if (uncompress(reinterpret_cast<Bytef*>(held.data()),
                       &size,
                       reinterpret_cast<const Bytef*>(pdf.data() + at),
                       end - at) == Z_OK) {
            objects.append(held, 0, size);
        }
        at = end + ends.size();
    }
    return objects;
}

TEST(HtmlReport, HasEveryFigureAndTheVerdictFirst) {
    const auto document =
        round_report(source_of(table3(), {"red", "silver", "sand", "blue"}, 4000));
    const std::string html = html_of(document);
    for (const char* part : {"Silver leads, not separated from blue",
                             "p = 0.0059 (exact)",
                             "chi-square 6.80",
                             ">0.109<",
                             "Friedman's Q 11.53",
                             "0.384",
                             "from 14.5 on",
                             ">2.37<",
                             "0.74 to 8.69",
                             "0.71 to 7.95",
                             ">0.607<",
                             ">0.926<",
                             "91%",
                             "not recorded",
                             "may not be topped up"}) {
        EXPECT_NE(html.find(part), std::string::npos) << part;
    }
    EXPECT_LT(html.find("Silver leads"), html.find("<table"));
}

TEST(HtmlReport, CanBeReadWithoutEyesAndAsksNothingOfAnybody) {
    const std::string html = html_of(round_report(source_of(table3(), kHostile)));
    EXPECT_EQ(count_of(html, "<h1>"), 1u);
    EXPECT_EQ(count_of(html, "<table>"), count_of(html, "<caption>"));
    EXPECT_EQ(count_of(html, "<svg"), count_of(html, "<desc"));
    EXPECT_EQ(count_of(html, "<svg"), count_of(html, "role=\"img\""));
    EXPECT_EQ(count_of(html, "<tbody>"), count_of(html, "<thead>"));
    EXPECT_GT(count_of(html, "scope=\"col\""), 20u);
    EXPECT_GT(count_of(html, "scope=\"row\""), 20u);
    EXPECT_NE(html.find("lang=\"en\""), std::string::npos);
    EXPECT_EQ(html.find("<script"), std::string::npos);
    EXPECT_EQ(html.find("javascript"), std::string::npos);
    EXPECT_EQ(html.find("<link"), std::string::npos);
    EXPECT_EQ(html.find("@import"), std::string::npos);
    // Addresses of namespaces are no requests.
    std::string rest = std::regex_replace(html, std::regex("xmlns=\"[^\"]*\""), "");
    EXPECT_EQ(rest.find("http://"), std::string::npos);
    EXPECT_EQ(rest.find("https://"), std::string::npos);
    EXPECT_EQ(rest.find("url("), std::string::npos);
    EXPECT_NE(html.find("&lt;script&gt;alert(1)&lt;/script&gt; &amp; &quot;co&quot;"),
              std::string::npos);
    EXPECT_NE(html.find("赤いメタリック"), std::string::npos);
}

TEST(HtmlReport, SaysOfNobodyAndOfOneWhatThereIsToSay) {
    const auto nobody = round_report(source_of({{0, 0}, {0, 0}}, {"red", "blue"}));
    const std::string html = html_of(nobody);
    EXPECT_NE(html.find("Nobody has voted."), std::string::npos);
    EXPECT_EQ(html.find("nan"), std::string::npos);
    EXPECT_EQ(html.find("<svg"), std::string::npos);
    const std::string one =
        html_of(round_report(source_of({{0, 1, 0}, {1, 0, 0}}, default_names(3))));
    EXPECT_NE(one.find("One evaluator prefers (b)"), std::string::npos);
    EXPECT_EQ(one.find("may not be topped up"), std::string::npos);
}

TEST(HtmlReport, CallsNobodyALeaderWithoutAPreference) {
    const std::string even =
        html_of(round_report(source_of({{5, 3, 2}, {2, 4, 4}}, default_names(3))));
    EXPECT_NE(even.find("show no preference"), std::string::npos);
    EXPECT_NE(even.find("None is shown"), std::string::npos);
    EXPECT_EQ(even.find("The leader is first"), std::string::npos);
    EXPECT_EQ(even.find("of rounds of as many other evaluators."), std::string::npos);
    const std::string told = html_of(round_report(source_of(table3(), default_names(4))));
    EXPECT_NE(told.find("The leader is first"), std::string::npos);
}

TEST(HtmlReport, HasPicturesWithinItself) {
    ReportDocument document;
    document.title = "pictures";
    document.blocks.emplace_back(
        ReportPictures{{{"caption", "what it shows", Image8(5, 3, 3, std::uint8_t{128})}}});
    const std::string html = html_of(document);
    EXPECT_NE(html.find("src=\"data:image/png;base64,iVBORw0KGgo"), std::string::npos);
    EXPECT_NE(html.find("alt=\"what it shows\""), std::string::npos);
}

TEST(PdfReport, IsOneWhateverTheNamesHold) {
    const PdfFile plain =
        pdf_of(round_report(source_of(table3(), {"red", "silver", "sand", "blue"})));
    EXPECT_TRUE(plain.bytes.starts_with("%PDF-1."));
    EXPECT_NE(plain.bytes.find("%%EOF"), std::string::npos);
    const std::string objects = objects_of(plain.bytes);
    EXPECT_EQ(count_of(objects, "/Type /Page "), static_cast<std::size_t>(plain.pages));
    EXPECT_EQ(plain.unknown_characters, 0);
    EXPECT_NE(objects.find("/StructTreeRoot"), std::string::npos);
    EXPECT_NE(objects.find("Inter"), std::string::npos) << "the font is embedded";
    const PdfFile hostile = pdf_of(round_report(source_of(table3(), kHostile)));
    EXPECT_TRUE(hostile.bytes.starts_with("%PDF-1."));
    EXPECT_GE(hostile.pages, plain.pages);
}

TEST(PdfReport, BreaksPicturesOverPages) {
    // A picture that begins a page is the first thing in its tag: once refused by Cairo.
    ReportPictures pictures;
    for (int k = 0; k < 12; ++k) {
        pictures.pictures.push_back(
            {std::to_string(k), "a look", Image8(64, 40, 3, static_cast<std::uint8_t>(20 * k))});
    }
    ReportDocument document;
    document.title = "pictures";
    document.blocks.push_back(pictures);
    EXPECT_EQ(pdf_of(document).pages, 2);
}

TEST(PdfReport, BreaksTablesOverPages) {
    ReportDocument document;
    document.title = "a long table";
    ReportTable table{"numbers", {{"what", false}, {"value"}}, {}};
    for (int k = 0; k < 200; ++k) table.rows.push_back({"row " + std::to_string(k), "1"});
    document.blocks.emplace_back(table);
    const PdfFile file = pdf_of(document);
    EXPECT_GE(file.pages, 4);
    EXPECT_LE(file.pages, 7);
    // One with a word of any length, and one with more columns than fit.
    ReportTable wide{"wide", {}, {{}}};
    for (int k = 0; k < 30; ++k) {
        wide.columns.push_back({"a column " + std::to_string(k)});
        wide.rows[0].push_back(std::string(80, 'x'));
    }
    document.blocks = {wide};
    EXPECT_GE(pdf_of(document).pages, 1);
    document.blocks.clear();
    document.title.clear();
    EXPECT_EQ(pdf_of(document).pages, 1);
}

}  // namespace
}  // namespace livery
