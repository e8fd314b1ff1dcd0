#include "tests/app/view/xdnd_file.h"

#include <X11/Xatom.h>
#include <X11/Xlib.h>

#include <array>
#include <stdexcept>

namespace app::test {

struct DraggedFile::Connection {
    Display* display;
    Window source, target;
    std::string list;  ///< text/uri-list
    bool isDropped = false, isTaken = false;

    Atom atom(const char* name) const { return XInternAtom(display, name, False); }

    Window find(const std::string& title) const
    {
        Window root, parent, *children = nullptr, found = 0;
        unsigned count = 0;
        XQueryTree(display, DefaultRootWindow(display), &root, &parent, &children, &count);
        for (unsigned n = 0; n < count; ++n) {
            char* name = nullptr;
            if (XFetchName(display, children[n], &name) != 0 && title == name) found = children[n];
            if (name != nullptr) XFree(name);
        }
        if (children != nullptr) XFree(children);
        return found;
    }

    void send(const char* message, const std::array<long, 4>& data) const
    {
        XEvent event = {};
        event.xclient.type = ClientMessage;
        event.xclient.window = target;
        event.xclient.message_type = atom(message);
        event.xclient.format = 32;
        event.xclient.data.l[0] = static_cast<long>(source);
        for (std::size_t n = 0; n < data.size(); ++n) event.xclient.data.l[n + 1] = data[n];
        XSendEvent(display, target, False, NoEventMask, &event);
        XFlush(display);
    }

    void answer(const XSelectionRequestEvent& request) const
    {
        XChangeProperty(display, request.requestor, request.property, request.target, 8, PropModeReplace,
                        reinterpret_cast<const unsigned char*>(list.data()), static_cast<int>(list.size()));
        XEvent event = {};
        event.xselection = {.type = SelectionNotify,
                            .serial = 0,
                            .send_event = True,
                            .display = display,
                            .requestor = request.requestor,
                            .selection = request.selection,
                            .target = request.target,
                            .property = request.property,
                            .time = request.time};
        XSendEvent(display, request.requestor, False, NoEventMask, &event);
        XFlush(display);
    }
};

DraggedFile::DraggedFile(const std::filesystem::path& file, const std::string& window)
    : connection_(new Connection{XOpenDisplay(nullptr), 0, 0, "file://" + std::filesystem::absolute(file).string() + "\r\n"})
{
    Connection& c = *connection_;
    if (c.display == nullptr) throw std::runtime_error("no display to drag a file on");
    c.source = XCreateSimpleWindow(c.display, DefaultRootWindow(c.display), 0, 0, 1, 1, 0, 0, 0);
    c.target = c.find(window);
    if (c.target == 0) throw std::runtime_error("no window to drag a file onto");
    constexpr long kVersion = 5;
    XSetSelectionOwner(c.display, c.atom("XdndSelection"), c.source, CurrentTime);
    c.send("XdndEnter", {kVersion << 24, static_cast<long>(c.atom("text/uri-list")), 0, 0});
    c.send("XdndPosition", {0, 10 << 16 | 10, CurrentTime, static_cast<long>(c.atom("XdndActionCopy"))});
}

DraggedFile::~DraggedFile()
{
    if (connection_->display != nullptr) XCloseDisplay(connection_->display);
}

bool DraggedFile::isTaken()
{
    Connection& c = *connection_;
    while (XPending(c.display) > 0) {
        XEvent event;
        XNextEvent(c.display, &event);
        if (event.type == SelectionRequest) c.answer(event.xselectionrequest);
        if (event.type != ClientMessage) continue;
        if (event.xclient.message_type == c.atom("XdndStatus") && !c.isDropped) {
            c.isDropped = true;
            c.send("XdndDrop", {0, CurrentTime, 0, 0});
        }
        if (event.xclient.message_type == c.atom("XdndFinished")) c.isTaken = true;
    }
    return c.isTaken;
}

}  // namespace app::test
