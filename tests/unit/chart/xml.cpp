#include "tests/unit/chart/xml.h"

#include <cctype>
#include <set>
#include <vector>

namespace burnish::test {
namespace {

class Reader {
  public:
    explicit Reader(const std::string& text) : text_(text) {}
    std::string fault()
    {
        bool rooted = false;
        while (at_ < text_.size() && fault_.empty()) {
            if (text_[at_] != '<')
                content();
            else if (text_.compare(at_, 2, "</") == 0)
                end_tag();
            else if (open_.empty() && rooted)
                wrong("a second root");
            else
                rooted = true, start_tag();
        }
        if (fault_.empty() && !open_.empty())
            wrong("never closed: " + open_.back());
        if (fault_.empty() && !rooted)
            wrong("no element");
        return fault_;
    }

  private:
    void wrong(const std::string& what)
    {
        if (fault_.empty())
            fault_ = what + " near '" + text_.substr(at_, 40) + "'";
    }
    bool take(char c)
    {
        if (at_ < text_.size() && text_[at_] == c)
            return ++at_, true;
        return false;
    }
    void blanks()
    {
        while (at_ < text_.size() && std::isspace(static_cast<unsigned char>(text_[at_])))
            ++at_;
    }
    std::string name()
    {
        const std::size_t begin = at_;
        while (at_ < text_.size() && (std::isalnum(static_cast<unsigned char>(text_[at_])) || text_[at_] == '-' || text_[at_] == ':'))
            ++at_;
        if (begin == at_)
            wrong("no name");
        return text_.substr(begin, at_ - begin);
    }
    void reference()
    {
        for (const char* known : {"&amp;", "&lt;", "&gt;", "&quot;"})
            if (text_.compare(at_, std::char_traits<char>::length(known), known) == 0) {
                at_ += std::char_traits<char>::length(known);
                return;
            }
        wrong("an unknown entity");
    }
    void content()
    {
        while (at_ < text_.size() && text_[at_] != '<' && fault_.empty())
            if (text_[at_] == '&')
                reference();
            else if (open_.empty() && !std::isspace(static_cast<unsigned char>(text_[at_])))
                wrong("text outside");
            else
                ++at_;
    }
    void start_tag()
    {
        ++at_;
        const std::string element = name();
        std::set<std::string> seen;
        for (;;) {
            blanks();
            if (!fault_.empty() || take('>'))
                break;
            if (take('/')) {
                if (!take('>'))
                    wrong("a stray /");
                return;
            }
            if (!seen.insert(name()).second)
                wrong("an attribute twice");
            if (!take('=') || !take('"'))
                wrong("an attribute without a quoted value");
            while (at_ < text_.size() && text_[at_] != '"' && text_[at_] != '<' && fault_.empty())
                if (text_[at_] == '&')
                    reference();
                else
                    ++at_;
            if (!take('"'))
                wrong("an open quote");
        }
        open_.push_back(element);
    }
    void end_tag()
    {
        at_ += 2;
        const std::string element = name();
        if (open_.empty() || open_.back() != element)
            return wrong("an end that matches nothing: " + element);
        open_.pop_back();
        if (!take('>'))
            wrong("an open end tag");
    }

    const std::string& text_;
    std::size_t at_ = 0;
    std::vector<std::string> open_;
    std::string fault_;
};

} // namespace

std::string xml_fault(const std::string& text)
{
    return Reader(text).fault();
}

} // namespace burnish::test
