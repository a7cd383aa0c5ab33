#include <QAbstractButton>
#include <QAction>
#include <QApplication>
#include <QComboBox>
#include <QDockWidget>
#include <QElapsedTimer>
#include <QFile>
#include <QGenericPlugin>
#include <QGridLayout>
#include <QJsonArray>
#include <QJsonDocument>
#include <QLabel>
#include <QLineEdit>
#include <QMainWindow>
#include <QMenu>
#include <QMenuBar>
#include <QMessageBox>
#include <QMouseEvent>
#include <QPixmap>
#include <QScreen>
#include <QSlider>
#include <QTextStream>
#include <QThread>
#include <QTimer>
#include <QTreeWidget>

#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <functional>
#include <map>

/// Uses the program it runs in as a person would, by menus, sliders and buttons. It is given the name of a file in the
/// variable MULTIRES_PILOT: a JSON list of commands, each a list of words (see Pilot::command).
///
/// Each command waits until it can be done and is then done; the program ends after the last with status 0, or with 1
/// and a word on standard error if a command cannot be done in two minutes, or if a message box appears that no command
/// is waiting for. Nothing depends on how long anything takes.
class Pilot final : public QObject {
    Q_OBJECT

public:
    Pilot() {
        QFile file(qEnvironmentVariable("MULTIRES_PILOT"));
        if (!file.open(QIODevice::ReadOnly)) fail("cannot read the commands");
        script_ = QJsonDocument::fromJson(file.readAll()).array();
        if (script_.isEmpty()) fail("no commands");
        waiting_.start();
        tick();
    }

private:
    /// Does a command and returns true, or returns false if it cannot be done yet.
    using Command = std::function<bool()>;

    Command command(const QString& verb) {
        const std::map<QString, Command> commands = {
            {"menus", [this] { return write_menus(word(1)); }},       // FILE: all entries, "Filters/Submenu/Entry"
            {"choose", [this] { return choose(word(1)); }},           // ENTRY of a menu; may open a modal dialog
            {"press", [this] { return press(word(1)); }},             // BUTTON of the foremost dialog
            {"slide", [this] { return slide(word(1), word(2)); }},    // LABEL, steps of 0..100; prints the time it took
            {"set", [this] { return set(word(1), word(2)); }},        // LABEL, text or name of a choice
            {"layer", [this] { return choose_layer(word(1)); }},      // NUMBER in the list of layers: becomes current
            {"copy", [this] { return copy(word(1), word(2)); }},      // FROM, TO
            {"picture", [this] { return picture(word(1)); }},         // FILE: the screen, when it has come to rest
            {"dialog", [this] { return describe_dialog(word(1)); }},  // FILE: the filter's dialog, likewise
        };
        const auto found = commands.find(verb);
        if (found == commands.end()) fail("no command " + verb);
        return found->second;
    }

    QString word(int i) const { return script_[next_].toArray()[i].toString(); }

    [[noreturn]] void fail(const QString& why) {
        std::fprintf(stderr, "pilot: command %d: %s\n", next_, qPrintable(why));
        std::_Exit(1);
    }

    void tick() {
        QTimer::singleShot(20, this, &Pilot::tick);  // not a timer that repeats, which would rest in a message's loop
        const auto* box = qobject_cast<QMessageBox*>(QApplication::activeModalWidget());
        if (box && busy_) fail("there is a message: " + box->text());  // the command would never return
        // Events get through while meshes are loaded at the start (the loop level tells) and while filters run and
        // files are written.
        if (busy_ || (acting_ && !QApplication::activeModalWidget()) || QThread::currentThread()->loopLevel() < 1)
            return;
        if (next_ == script_.size()) std::_Exit(0);  // a question on screen would keep quit() waiting
        const QString verb = word(0);
        if (box && verb != "press") fail("there is a message: " + box->text());
        if (waiting_.elapsed() > 120000) fail("cannot " + verb + " " + word(1));
        if (QApplication::activeModalWidget() && verb != "press") return;
        busy_ = true;
        const bool done = command(verb)();
        busy_ = false;
        if (!done) return;
        ++next_;
        waiting_.restart();
    }

    // ---- finding things ---------------------------------------------------------------------------------------------

    static QMainWindow* main_window() {
        for (QWidget* widget : QApplication::topLevelWidgets())
            if (auto* window = qobject_cast<QMainWindow*>(widget))
                if (window->isVisible()) return window;
        return nullptr;
    }

    /// The dock with an Apply button.
    static QDockWidget* dialog() {
        for (QWidget* widget : QApplication::allWidgets())
            if (auto* dock = qobject_cast<QDockWidget*>(widget))
                if (dock->isVisible() && button(dock, "Apply")) return dock;
        return nullptr;
    }

    static QAbstractButton* button(const QWidget* in, const QString& text) {
        for (auto* b : in->findChildren<QAbstractButton*>())
            if (b->isVisible() && b->text().remove('&') == text) return b;
        return nullptr;
    }

    /// The widget of a type in the row of the dialog that has the label, or one that begins so.
    template <class Widget>
    static Widget* field(const QString& label) {
        const QDockWidget* dock = dialog();
        if (!dock) return nullptr;
        const auto find = [&](const auto& matches) -> Widget* {
            for (auto* grid : dock->findChildren<QGridLayout*>())
                for (int row = 0; row < grid->rowCount(); ++row)
                    for (int column = 0; column + 1 < grid->columnCount(); ++column) {
                        QLayoutItem* item = grid->itemAtPosition(row, column);
                        const auto* text = item ? qobject_cast<QLabel*>(item->widget()) : nullptr;
                        if (text && matches(text->text()))
                            if (auto* w = within<Widget>(grid->itemAtPosition(row, column + 1))) return w;
                    }
            return nullptr;
        };
        if (auto* w = find([&](const QString& text) { return text == label; })) return w;
        return find([&](const QString& text) { return text.startsWith(label); });
    }

    /// An item of a layout, or one of a layout in it.
    template <class Widget>
    static Widget* within(QLayoutItem* item) {
        if (!item) return nullptr;
        if (auto* w = qobject_cast<Widget*>(item->widget())) return w;
        if (QLayout* layout = item->layout())
            for (int i = 0; i < layout->count(); ++i)
                if (auto* w = within<Widget>(layout->itemAt(i))) return w;
        return nullptr;
    }

    // ---- commands ---------------------------------------------------------------------------------------------------

    bool write_menus(const QString& name) {
        const QMainWindow* window = main_window();
        if (!window) return false;
        QFile file(name);
        if (!file.open(QIODevice::WriteOnly)) fail("cannot write " + name);
        QTextStream out(&file);
        each_entry("", window->menuBar()->actions(), [&](const QString& path, QAction*) { out << path << "\n"; });
        return true;
    }

    template <class With>
    static void each_entry(const QString& path, const QList<QAction*>& actions, const With& with) {
        for (QAction* action : actions) {
            const QString here = path + action->text().remove('&');
            if (action->menu())
                each_entry(here + "/", action->menu()->actions(), with);
            else if (!action->isSeparator())
                with(here, action);
        }
    }

    bool choose(const QString& entry) {
        const QMainWindow* window = main_window();
        if (!window || QApplication::activeModalWidget()) return false;
        arrange();  // which also makes later versions bring their menus up to date
        QAction* found = nullptr;
        each_entry("", window->menuBar()->actions(), [&](const QString& path, QAction* action) {
            if (path.section('/', -1) == entry && action->isEnabled()) found = action;
        });
        if (!found) return false;
        acting_ = true;
        QTimer::singleShot(0, this, [this, found] {  // not from here: it may not return before a dialog is closed
            found->trigger();
            acting_ = false;
        });
        return true;
    }

    bool press(const QString& text) {
        const QWidget* in = QApplication::activeModalWidget();
        if (!in) in = dialog();
        QAbstractButton* found = in ? button(in, text) : nullptr;
        if (!found || !found->isEnabled()) return false;
        found->click();
        return true;
    }

    bool slide(const QString& label, const QString& steps) {
        auto* slider = field<QSlider>(label);
        if (!slider) return false;
        QElapsedTimer clock;
        clock.start();
        const std::clock_t begin = std::clock();
        slider->setValue(steps.toInt());
        QApplication::processEvents();  // what it has to paint
        const double work = 1000.0 * static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
        std::printf("slide %s: %lld ms, %.0f ms of work on all cores\n", qPrintable(label), clock.elapsed(), work);
        std::fflush(stdout);
        return true;
    }

    bool set(const QString& label, const QString& value) {
        if (auto* box = field<QComboBox>(label)) {
            const int i = box->findText(value);
            if (i < 0) fail(label + " has no choice " + value);
            box->setCurrentIndex(i);
            emit box->activated(i);
            return true;
        }
        auto* line = field<QLineEdit>(label);
        if (!line) return false;
        line->setText(value);
        emit line->editingFinished();
        return true;
    }

    bool choose_layer(const QString& number) {
        const QMainWindow* window = main_window();
        const auto* list = window ? window->findChild<QTreeWidget*>("meshTreeWidget") : nullptr;
        const auto found = list ? list->findItems(number, Qt::MatchExactly, 1) : QList<QTreeWidgetItem*>();
        if (found.isEmpty()) return false;
        const int row = list->visualItemRect(found.front()).center().y();
        const QPoint place(list->columnViewportPosition(1) + list->columnWidth(1) / 2, row);
        for (const auto type : {QEvent::MouseButtonPress, QEvent::MouseButtonRelease}) {
            QMouseEvent event(type, place, Qt::LeftButton, Qt::LeftButton, Qt::NoModifier);
            QApplication::sendEvent(list->viewport(), &event);
        }
        return true;
    }

    bool copy(const QString& from, const QString& to) {
        if (!QFile::copy(from, to)) fail("cannot copy " + from + " to " + to);
        return true;
    }

    /// The window everywhere, the dialog at the right: there is no window manager to do it.
    static void arrange() {
        const QRect screen = QGuiApplication::primaryScreen()->geometry();
        if (QMainWindow* window = main_window(); window && window->geometry() != screen) window->setGeometry(screen);
        if (QDockWidget* dock = dialog(); dock && dock->isFloating()) dock->move(screen.width() - dock->width(), 0);
    }

    bool picture(const QString& name) {
        arrange();
        const QImage now = QGuiApplication::primaryScreen()->grabWindow(0).toImage();
        const bool rests = now == before_;
        before_ = now;
        if (!rests) return false;
        if (!now.save(name)) fail("cannot write " + name);
        before_ = QImage();
        return true;
    }

    bool describe_dialog(const QString& name) {
        QDockWidget* dock = dialog();
        if (!dock) return false;
        const QImage now = dock->grab().toImage();
        const bool rests = now == before_;
        before_ = now;
        if (!rests) return false;
        before_ = QImage();
        QFile file(name + ".txt");
        if (!now.save(name + ".png") || !file.open(QIODevice::WriteOnly)) fail("cannot write " + name);
        QTextStream out(&file);
        for (const auto* label : dock->findChildren<QLabel*>())
            if (label->isVisible()) out << label->text() << "\n";
        for (const auto* b : dock->findChildren<QAbstractButton*>())
            if (b->isVisible()) out << b->text() << "\n";
        return true;
    }

    QElapsedTimer waiting_;
    QJsonArray script_;
    int next_ = 0;
    bool busy_ = false;    ///< with a command
    bool acting_ = false;  ///< an entry that was chosen is being carried out; it may open a modal dialog
    QImage before_;
};

/// How it gets into the program: Qt itself loads the generic plugins that QT_QPA_GENERIC_PLUGINS names.
class PilotPlugin final : public QGenericPlugin {
    Q_OBJECT
    Q_PLUGIN_METADATA(IID QGenericPluginFactoryInterface_iid FILE "pilot.json")

public:
    QObject* create(const QString& /*key*/, const QString& /*specification*/) override { return new Pilot(); }
};

#include "pilot.moc"
