#include "evaluation/typed_words.h"

#include <stdexcept>

#include <gtest/gtest.h>

namespace livery {
namespace {

TEST(EvaluatorName, IsKeptAsTypedButTidy) {
    EXPECT_EQ(tidy_name("Ann"), "Ann");
    EXPECT_EQ(tidy_name("  Ann \t van  der Berg "), "Ann van der Berg");
    EXPECT_EQ(tidy_name("\u00a0\u3000Bo\u2003Li\ufeff"), "Bo Li") << "other scripts' spaces";
    EXPECT_EQ(tidy_name("佐藤 🙂"), "佐藤 🙂");
    EXPECT_EQ(tidy_name(std::string(200, 'x')).size(), 200u);
}

TEST(EvaluatorName, OnePersonHasOneKey) {
    for (const auto& [one, other] : {std::pair{"Ann", " aNN "},
                                     {"Åsa Öberg", "åsa  öBERG"},
                                     {"ÆØÅ ÿ", "æøå Ÿ"},
                                     {"ŁUKASZ ŽÁČEK", "łukasz žáček"},
                                     {"ŌŢĲŊŹ", "ōţĳŋź"},
                                     {"NGUYỄN", "nguyễn"},
                                     {"ΣΊΣΥΦΟΣ Ώ", "σίσυφος ώ"},
                                     {"ЁЖИК ЩУКА", "ёжик щука"}}) {
        EXPECT_EQ(name_key(one), name_key(other)) << one;
    }
}

TEST(EvaluatorName, TwoPeopleHaveTwo) {
    for (const auto& [one, other] : {std::pair{"Ann", "Anna"},
                                     {"Ann Lee", "AnnLee"},
                                     {"Asa", "Åsa"},
                                     {"×", "÷"},
                                     {"佐藤", "斎藤"},
                                     {"Ivan", "Іван"}}) {
        EXPECT_NE(name_key(one), name_key(other)) << one;
    }
}

TEST(EvaluatorName, RefusesWhatIsNone) {
    const auto refused = [](const std::string& name, const std::string& found) {
        for (const auto& function : {tidy_name, name_key}) {
            try {
                function(name);
                ADD_FAILURE() << found << " was taken";
            } catch (const std::invalid_argument& error) {
                EXPECT_EQ(error.what(),
                          "evaluator: found " + found + ", expected a name of 1 to 200 bytes");
            }
        }
    };
    refused("", "no name");
    refused(" \t\u00a0 ", "no name");
    refused(std::string(201, 'x'), "201 bytes");
    refused("two\nlines", "a control character");
    refused(std::string("nul\0", 4), "a control character");
    refused("\x1b[31m", "a control character");
    refused("\u2028", "a control character");
    for (const char* bytes : {"\xff",
                              "\xc3",
                              "\xc3(",
                              "\x80",
                              "\xc0\xaf",
                              "\xe0\x80\xaf",
                              "\xed\xa0\x80",
                              "\xf4\x90\x80\x80",
                              "\xf8\x88\x80\x80\x80"}) {
        refused(bytes, "a text that is not UTF-8");
    }
}

TEST(SemanticScale, IsTwoWordsWithAComma) {
    EXPECT_EQ(parse_scale(" cheap , precious "), (SemanticScale{"cheap", "precious"}));
    EXPECT_EQ(parse_scale("schlicht,auffällig"), (SemanticScale{"schlicht", "auffällig"}));
    EXPECT_EQ(in_words({"cheap", "precious"}), "cheap – precious");
    const std::string longest(24, 'x');
    EXPECT_EQ(parse_scale(text_of({longest, "y"})).low, longest);
    for (const std::string& bad : {std::string(),
                                   std::string("cheap"),
                                   std::string("cheap,"),
                                   std::string(",precious"),
                                   std::string("a,b,c"),
                                   std::string("cheap;dear,b"),
                                   std::string("Cheap,cheap"),
                                   std::string("a\tb,c"),
                                   std::string("a\nb,c"),
                                   std::string("a\xff,c"),
                                   std::string("\u202eevil,c"),
                                   std::string("a,\u200b"),
                                   std::string(25, 'x') + ",y"}) {
        EXPECT_THROW(parse_scale(bad), std::invalid_argument) << bad;
    }
    EXPECT_NO_THROW(parse_scale("</script><b>,\"}alert(1)//")) << "it is text";
    EXPECT_NO_THROW(check_scales(suggested_scales()));
    std::vector<SemanticScale> scales = suggested_scales();
    scales.push_back({"low", "high"});
    EXPECT_THROW(check_scales(scales), std::invalid_argument) << "six";
    EXPECT_THROW(check_scales({{"a", "b"}, {"a", "b"}}), std::invalid_argument);
}

}  // namespace
}  // namespace livery
