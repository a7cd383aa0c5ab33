#include <QAction>
#include <QApplication>
#include <QFile>
#include <QMainWindow>
#include <QMenu>
#include <QMenuBar>
#include <QTextStream>
#include <QTimer>
#include <QtPlugin>

#include <cstdlib>

/// A Qt plugin that MeshLab opens at start like any other: once the main window stands, it writes every menu entry to
/// the file that the variable MULTIRES_MENU_FILE names, one a line as "Filters/Submenu/Entry", and ends the program.
/// It is of no interface that MeshLab knows, and does nothing without that variable.
class MenuSpy final : public QObject {
    Q_OBJECT
    Q_PLUGIN_METADATA(IID "multires.MenuSpy/1.0")

public:
    MenuSpy() {
        if (qEnvironmentVariableIsEmpty("MULTIRES_MENU_FILE")) return;
        connect(&timer_, &QTimer::timeout, this, &MenuSpy::look);
        timer_.start(100);
    }

private:
    void look() {
        for (QWidget* widget : QApplication::topLevelWidgets()) {
            const auto* window = qobject_cast<QMainWindow*>(widget);
            if (!window || !window->isVisible()) continue;
            QFile file(qEnvironmentVariable("MULTIRES_MENU_FILE"));
            if (!file.open(QIODevice::WriteOnly)) std::_Exit(1);
            QTextStream out(&file);
            write(out, "", window->menuBar()->actions());
            out.flush();
            file.close();
            std::_Exit(0);  // a question on screen would keep quit() waiting
        }
    }

    static void write(QTextStream& out, const QString& path, const QList<QAction*>& actions) {
        for (const QAction* action : actions) {
            const QString here = path + action->text().remove('&');
            if (action->menu())
                write(out, here + "/", action->menu()->actions());
            else if (!action->isSeparator())
                out << here << "\n";
        }
    }

    QTimer timer_;
};

#include "menu_spy.moc"
