//! Curves on axes, as SVG that any browser shows with its own letters.

use std::error::Error;

use maud::{Markup, PreEscaped, html};
use plotters::chart::ChartContext;
use plotters::coord::Shift;
use plotters::element::{ComposedElement, DashedPathElement};
use plotters::prelude::*;

use super::axis_spec::AxisSpec;
use crate::render::map::short_number;

/// Colours for curves, sRGB-coded: orange, blue and grey, which the colour-blind tell apart. In the dark scheme pages
/// brighten them; others stay as they are.
pub const CURVE_COLOURS: [[u8; 3]; 3] = [[213, 94, 0], [0, 114, 178], [120; 3]];

/// Height of a row of ticks as a share of the plot's.
const TICK: f64 = 0.035;

/// Pixels that a number takes along the axis across, and along the one up.
const ROOM: [u32; 2] = [44, 34];

/// Size of letters, pixels, and the mean width of one.
const LETTERS: i32 = 13;
const LETTER_WIDTH: f64 = 6.6;

/// Height of a row of the legend, length of the line before a name, and the gaps behind that and behind the name,
/// pixels.
const ROW: i32 = 22;
const SAMPLE: i32 = 22;
const GAPS: [i32; 2] = [6, 16];

/// An axis.
#[derive(Clone, Copy, Debug)]
pub struct Axis<'a> {
    /// What it counts, with its unit.
    pub name: &'a str,
    /// Whether steps are factors; else the axis begins at zero.
    pub logarithmic: bool,
}

/// How the points of a curve are drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stroke {
    /// A line.
    Line,
    /// A dashed line.
    Dashed,
    /// A line with a filled circle at each point.
    Circles,
    /// A line with an open square at each point.
    Squares,
    /// A short line at each point's place across, in this row from the bottom.
    Ticks(u8),
}

/// A named list of points.
#[derive(Clone, Debug)]
pub struct Curve {
    /// What it is called in the legend; nothing, and it is not there.
    pub name: String,
    /// Its colour, sRGB-coded.
    pub colour: [u8; 3],
    /// How it is drawn.
    pub stroke: Stroke,
    /// Its points, across and up. On a logarithmic axis, what is not above zero is left out.
    pub points: Vec<(f64, f64)>,
}

/// Curves, and what their axes mean.
#[derive(Clone, Debug)]
pub struct Plot<'a> {
    /// Pixels across and up, at its natural size.
    pub size: [u32; 2],
    /// From left to right.
    pub across: Axis<'a>,
    /// From bottom to top.
    pub up: Axis<'a>,
    /// Later ones lie over earlier ones.
    pub curves: Vec<Curve>,
}

/// The plot as a figure; `alt` says what there is to see, for those who do not see it.
pub fn plot(plot: &Plot<'_>, alt: &str) -> Markup {
    // Within HTML the drawing needs neither a size nor the name of its language.
    let svg = plot.svg().replacen(" xmlns=\"http://www.w3.org/2000/svg\"", "", 1);
    // Letters that are much enlarged are too large.
    let style = format!("max-width: {}px", plot.size[0] * 6 / 5);
    html! {
        figure.plot role="img" aria-label=(alt) style=(style) { (PreEscaped(svg)) }
    }
}

impl Plot<'_> {
    /// The plot as an SVG file of its own; empty if it has no point.
    pub fn svg(&self) -> String {
        let mut svg = String::new();
        // Writing into memory cannot fail, and the axes are sound.
        if self.draw(&mut svg).is_err() { String::new() } else { svg }
    }

    fn draw(&self, svg: &mut String) -> Result<(), Box<dyn Error>> {
        let across = self.spec(self.across, |p| p.0, self.size[0] / ROOM[0]);
        let up = self.spec(self.up, |p| p.1, self.size[1] / ROOM[1]);
        let Some((across, up)) = across.zip(up) else { return Ok(()) };
        let area = SVGBackend::with_string(svg, self.size.into()).into_drawing_area();
        area.fill(&WHITE)?;
        let (_, below) = area.split_vertically(self.draw_legend(&area)?);
        let mut chart = ChartBuilder::on(&below)
            .margin_top(4)
            .margin_right(14)
            .x_label_area_size(42)
            .y_label_area_size(46)
            .build_cartesian_2d(across, up)?;
        chart
            .configure_mesh()
            .light_line_style(TRANSPARENT)
            .bold_line_style(BLACK.mix(0.12))
            .axis_style(BLACK.mix(0.4))
            .x_desc(self.across.name)
            .x_label_formatter(&|x| short_number(*x))
            .y_label_formatter(&|y| short_number(*y))
            .label_style(("sans-serif", LETTERS))
            .draw()?;
        for curve in &self.curves {
            self.draw_curve(&mut chart, curve)?;
        }
        area.present()?;
        Ok(())
    }

    /// What the axis upwards counts, then the names of the curves, in as many rows as they need; tells how high that
    /// is, pixels.
    fn draw_legend(
        &self,
        area: &DrawingArea<SVGBackend<'_>, Shift>,
    ) -> Result<i32, Box<dyn Error>> {
        let length = |text: &str| (text.chars().count() as f64 * LETTER_WIDTH) as i32;
        let style = ("sans-serif", LETTERS).into_font().color(&BLACK);
        area.draw(&Text::new(self.up.name, (GAPS[0], 4), style.clone()))?;
        let first = GAPS[0] + length(self.up.name) + GAPS[1];
        let (mut left, mut top) = (first, 4);
        for curve in self.curves.iter().filter(|curve| !curve.name.is_empty()) {
            let whole = SAMPLE + GAPS[0] + length(&curve.name);
            if left > first && left + whole > self.size[0] as i32 {
                (left, top) = (first, top + ROW);
            }
            let middle = top + LETTERS / 2;
            curve.draw_sample(area, [left, middle])?;
            let name = (left + SAMPLE + GAPS[0], top);
            area.draw(&Text::new(curve.name.as_str(), name, style.clone()))?;
            left += whole + GAPS[1];
        }
        Ok(top + ROW)
    }

    /// An axis for all points, with a number at every so many pixels; `None` without points.
    fn spec(
        &self,
        axis: Axis<'_>,
        of: impl Fn(&(f64, f64)) -> f64,
        count: u32,
    ) -> Option<AxisSpec> {
        let ticks = |curve: &&Curve| !matches!(curve.stroke, Stroke::Ticks(_));
        let values = self.curves.iter().filter(ticks).flat_map(|curve| &curve.points).map(of);
        match axis.logarithmic {
            true => AxisSpec::logarithmic(values, count as usize),
            false => AxisSpec::linear(values, count as usize),
        }
    }

    fn draw_curve<'b>(
        &self,
        chart: &mut ChartContext<'b, SVGBackend<'b>, Cartesian2d<AxisSpec, AxisSpec>>,
        curve: &Curve,
    ) -> Result<(), Box<dyn Error>> {
        let line = curve.line();
        let sound = |&(x, y): &(f64, f64)| {
            let fits = |value: f64, axis: Axis<'_>| {
                value.is_finite() && (value > 0.0 || !axis.logarithmic)
            };
            fits(x, self.across) && fits(y, self.up)
        };
        let points: Vec<(f64, f64)> = curve.points.iter().copied().filter(sound).collect();
        match curve.stroke {
            Stroke::Ticks(row) => {
                let range = chart.y_range();
                let at = |share: f64| range.start + share * (range.end - range.start);
                let [foot, top] = [0.1, 0.9].map(|part| at((f64::from(row) + part) * TICK));
                let tick = |&(x, _): &(f64, f64)| {
                    PathElement::new([(x, foot), (x, top)], line.color.stroke_width(1))
                };
                chart.draw_series(points.iter().map(tick))?;
                return Ok(());
            }
            Stroke::Dashed => {
                chart.draw_series(DashedLineSeries::new(points.clone(), 6, 4, line))?;
            }
            _ => {
                chart.draw_series(LineSeries::new(points.iter().copied(), line))?;
            }
        }
        let points = points.into_iter();
        match curve.stroke {
            Stroke::Circles => {
                chart.draw_series(points.map(|at| circle(at, line)))?;
            }
            Stroke::Squares => {
                chart.draw_series(points.map(|at| square(at, line)))?;
            }
            _ => (),
        }
        Ok(())
    }
}

impl Curve {
    fn line(&self) -> ShapeStyle {
        let [r, g, b] = self.colour;
        RGBColor(r, g, b).stroke_width(2)
    }

    /// A short piece of it, as the legend has it, from a point to the right.
    fn draw_sample(
        &self,
        area: &DrawingArea<SVGBackend<'_>, Shift>,
        [left, middle]: [i32; 2],
    ) -> Result<(), Box<dyn Error>> {
        let line = self.line();
        let whole = [(left, middle), (left + SAMPLE, middle)];
        let centre = (left + SAMPLE / 2, middle);
        match self.stroke {
            Stroke::Ticks(_) => {
                let upright = [(centre.0, middle - 5), (centre.0, middle + 5)];
                area.draw(&PathElement::new(upright, line))?;
            }
            Stroke::Dashed => area.draw(&DashedPathElement::new(whole, 6, 4, line))?,
            _ => area.draw(&PathElement::new(whole, line))?,
        }
        match self.stroke {
            Stroke::Circles => area.draw(&circle(centre, line))?,
            Stroke::Squares => area.draw(&square(centre, line))?,
            _ => (),
        }
        Ok(())
    }
}

fn circle<C>(at: C, line: ShapeStyle) -> Circle<C, i32> {
    Circle::new(at, 4, line.color.filled())
}

/// An open square.
fn square<'b, C>(at: C, line: ShapeStyle) -> ComposedElement<C, SVGBackend<'b>, Box4, Box4> {
    EmptyElement::at(at)
        + Rectangle::new([(-4, -4), (4, 4)], WHITE.filled())
        + Rectangle::new([(-4, -4), (4, 4)], line)
}

type Box4 = Rectangle<(i32, i32)>;
