//! Tables of figures.

use maud::{Markup, html};

/// A table that sorts by a click on a header and goes out as CSV.
#[derive(Clone, Debug)]
pub struct Table<'a> {
    /// What it is about, above it; nothing if empty.
    pub caption: &'a str,
    /// Names of the columns, with units.
    pub header: &'a [&'a str],
    /// Rows, each as long as the header.
    pub rows: Vec<Vec<Cell>>,
    /// Name that the CSV is downloaded under.
    pub file: &'a str,
}

/// What stands in a table.
#[derive(Clone, Debug, PartialEq)]
pub enum Cell {
    /// Words, sorted as people would.
    Text(String),
    /// A number, sorted by its value and written to the CSV in full.
    Number {
        /// The value.
        value: f64,
        /// What is seen of it.
        shown: String,
    },
    /// Nothing is known.
    Empty,
}

impl Cell {
    /// Words.
    pub fn text(text: impl Into<String>) -> Self {
        Self::Text(text.into())
    }

    /// A number with so many digits behind the point; empty if it is none.
    pub fn number(value: f64, decimals: usize) -> Self {
        let shown = format!("{value:.decimals$}");
        if value.is_finite() { Self::Number { value, shown } } else { Self::Empty }
    }

    /// A number of things.
    pub fn count(count: usize) -> Self {
        Self::Number { value: count as f64, shown: count.to_string() }
    }
}

/// The table; without scripts it neither sorts nor downloads.
pub fn table(table: &Table<'_>) -> Markup {
    let is_number = |column: usize| {
        table.rows.iter().any(|row| matches!(row.get(column), Some(Cell::Number { .. })))
    };
    html! {
        figure.table {
            div.scroll {
                table data-file=(table.file) {
                    @if !table.caption.is_empty() { caption { (table.caption) } }
                    thead {
                        tr {
                            @for (column, name) in table.header.iter().enumerate() {
                                th.number[is_number(column)] scope="col" { (name) }
                            }
                        }
                    }
                    tbody {
                        @for row in &table.rows {
                            tr { @for cell in row { (written(cell)) } }
                        }
                    }
                }
            }
        }
    }
}

fn written(cell: &Cell) -> Markup {
    match cell {
        Cell::Text(text) => html! { td { (text) } },
        Cell::Number { value, shown } => html! { td.number data-value=(value) { (shown) } },
        Cell::Empty => html! { td {} },
    }
}

/// A few results to be read at a glance, a row for each thing.
#[derive(Clone, Debug)]
pub struct Board<'a> {
    /// What they say, above them.
    pub caption: &'a str,
    /// Names of the columns, but for the first, which has those of the rows.
    pub header: &'a [&'a str],
    /// The rows.
    pub rows: Vec<BoardRow>,
}

/// A row of a [`Board`].
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct BoardRow {
    /// What it is about.
    pub name: String,
    /// As many as the header names.
    pub cells: Vec<String>,
}

/// The results; they neither sort nor download.
pub fn board(board: &Board<'_>) -> Markup {
    html! {
        figure.board {
            figcaption { (board.caption) }
            div.scroll {
                table {
                    thead { tr { td {} @for name in board.header { th scope="col" { (name) } } } }
                    tbody {
                        @for row in &board.rows {
                            tr { th scope="row" { (row.name) } @for cell in &row.cells { td { (cell) } } }
                        }
                    }
                }
            }
        }
    }
}

/// Something that is known.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Fact<'a> {
    /// What it is about.
    pub name: &'a str,
    /// What it is.
    pub value: String,
}

/// What is known of something, row by row.
pub fn facts(rows: &[Fact<'_>]) -> Markup {
    html! {
        div.scroll {
            table.facts {
                tbody {
                    @for Fact { name, value } in rows {
                        tr { th scope="row" { (name) } td { (value) } }
                    }
                }
            }
        }
    }
}
