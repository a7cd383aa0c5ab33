#include "host/fold_2020.h"

#include <QApplication>
#include <QDockWidget>
#include <QFrame>
#include <QGridLayout>
#include <QLabel>
#include <QMainWindow>
#include <QTimer>
#include <QToolButton>

#include <vector>

namespace multires::host {
namespace {

constexpr const char* box_name = "multires_advanced";

/// The dialog of the filter, a dock in the main window with the filter's name for a title.
QDockWidget* dialog_of(const QString& title) {
    for (QWidget* window : QApplication::topLevelWidgets())
        for (QDockWidget* dock : window->findChildren<QDockWidget*>())
            if (dock->windowTitle() == title && dock->isVisible()) return dock;
    return nullptr;
}

/// The frame that has a grid with a row for each parameter, and that grid.
std::pair<QFrame*, QGridLayout*> rows_of(const QDockWidget& dialog, int parameters) {
    for (QFrame* frame : dialog.findChildren<QFrame*>()) {
        auto* grid = qobject_cast<QGridLayout*>(frame->layout());
        if (frame->inherits("RichParameterListFrame") && grid && grid->rowCount() == parameters) return {frame, grid};
    }
    return {nullptr, nullptr};
}

/// Moves the items of a row of one grid to the end of another.
void move_row(QGridLayout& from, int row, QGridLayout& to) {
    const int last = to.rowCount();
    for (int i = from.count() - 1; i >= 0; --i) {
        int at = 0, column = 0, rows = 0, columns = 0;
        from.getItemPosition(i, &at, &column, &rows, &columns);
        if (at != row) continue;
        QLayoutItem* item = from.takeAt(i);
        if (QWidget* widget = item->widget()) {
            const bool hidden = widget->isHidden();
            to.addWidget(widget, last, column, rows, columns, item->alignment());
            widget->setHidden(hidden);
            delete item;
        } else if (QLayout* layout = item->layout()) {
            layout->setParent(nullptr);
            to.addLayout(layout, last, column, rows, columns, item->alignment());
        }
    }
}

/// Lets the dialog be as tall as what is open in it, as the host does when it makes it.
void fit(QDockWidget& dialog, QFrame& frame) {
    frame.setMinimumSize(0, 0);
    frame.layout()->activate();
    frame.adjustSize();
    if (QWidget* inner = dialog.widget()) {
        if (inner->layout()) inner->layout()->activate();
        inner->adjustSize();
        dialog.setMinimumSize(inner->sizeHint());
    }
    dialog.adjustSize();
}

void fold(QDockWidget& dialog, QFrame& frame, QGridLayout& grid, const std::vector<int>& advanced) {
    auto* box = new QWidget(&frame);
    box->setObjectName(box_name);
    auto* inside = new QGridLayout(box);
    inside->setContentsMargins(0, 0, 0, 0);
    for (const int row : advanced) move_row(grid, row, *inside);
    auto* button = new QToolButton(&frame);
    button->setText("Advanced");
    button->setCheckable(true);
    button->setToolButtonStyle(Qt::ToolButtonTextBesideIcon);
    button->setArrowType(Qt::RightArrow);
    const int end = grid.rowCount();
    grid.addWidget(button, end, 0, 1, 3, Qt::AlignLeft);
    grid.addWidget(box, end + 1, 0, 1, 3);
    button->show();
    box->hide();
    QObject::connect(button, &QToolButton::toggled, box, [button, box, dock = &dialog, parent = &frame](bool open) {
        box->setVisible(open);
        button->setArrowType(open ? Qt::DownArrow : Qt::RightArrow);
        fit(*dock, *parent);
    });
    fit(dialog, frame);
}

}  // namespace

void fold_advanced(const plugin::Filter& filter) {
    if (!qobject_cast<QApplication*>(QCoreApplication::instance())) return;
    std::vector<int> advanced;
    int row = 0;
    const plugin::Call call = filter.call(nullptr);
    for (const plugin::Parameter& p : call.parameters) {
        if (p.hint.advanced) advanced.push_back(row);
        ++row;
    }
    if (advanced.empty()) return;
    // When the host has returned to its loop of events the dialog stands.
    QTimer::singleShot(0, qApp, [title = QString::fromStdString(filter.name), row, advanced] {
        QDockWidget* dialog = dialog_of(title);
        if (!dialog || dialog->findChild<QWidget*>(box_name)) return;
        const auto [frame, grid] = rows_of(*dialog, row);
        if (grid) fold(*dialog, *frame, *grid, advanced);
    });
}

}  // namespace multires::host
