//! Curves on axes, as SVG that any browser shows with its own letters.

use std::error::Error;
use std::ops::Range;

use maud::{Markup, PreEscaped, html};
use plotters::chart::ChartContext;
use plotters::coord::Shift;
use plotters::coord::ranged1d::{AsRangedCoord, Ranged, ValueFormatter};
use plotters::element::DashedPathElement;
use plotters::prelude::*;

/// How far the axes of logarithmic scales reach beyond the points, as a factor.
const MARGIN: f64 = 1.3;

/// Height of a row of ticks as a share of the plot's.
const TICK: f64 = 0.035;

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
    html! {
        figure.plot role="img" aria-label=(alt) { (PreEscaped(svg)) }
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
        let Some((across, up)) = self.range(self.across, |p| p.0).zip(self.range(self.up, |p| p.1))
        else {
            return Ok(());
        };
        let area = SVGBackend::with_string(svg, self.size.into()).into_drawing_area();
        area.fill(&WHITE)?;
        match (self.across.logarithmic, self.up.logarithmic) {
            (true, true) => self.draw_on(&area, across.log_scale(), up.log_scale())?,
            (true, false) => self.draw_on(&area, across.log_scale(), up)?,
            (false, true) => self.draw_on(&area, across, up.log_scale())?,
            (false, false) => self.draw_on(&area, across, up)?,
        }
        area.present()?;
        Ok(())
    }

    /// From the least to the greatest value of all points, with some air.
    fn range(&self, axis: Axis<'_>, of: impl Fn(&(f64, f64)) -> f64) -> Option<Range<f64>> {
        let ticks = |curve: &&Curve| !matches!(curve.stroke, Stroke::Ticks(_));
        let values = self.curves.iter().filter(ticks).flat_map(|curve| &curve.points).map(of);
        let sound = |x: &f64| x.is_finite() && (*x > 0.0 || !axis.logarithmic);
        let (low, high) = values
            .filter(sound)
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| (low.min(x), high.max(x)));
        (low <= high).then(|| match axis.logarithmic {
            true => low / MARGIN..high * MARGIN,
            false => low.min(0.0)..(high.max(low + f64::MIN_POSITIVE)) * 1.05,
        })
    }

    fn draw_on<X, Y>(
        &self,
        area: &DrawingArea<SVGBackend<'_>, Shift>,
        across: X,
        up: Y,
    ) -> Result<(), Box<dyn Error>>
    where
        X: AsRangedCoord<Value = f64>,
        Y: AsRangedCoord<Value = f64>,
        X::CoordDescType: Ranged<ValueType = f64> + ValueFormatter<f64>,
        Y::CoordDescType: Ranged<ValueType = f64> + ValueFormatter<f64>,
    {
        let mut chart = ChartBuilder::on(area)
            .margin(12)
            .x_label_area_size(40)
            .y_label_area_size(58)
            .build_cartesian_2d(across, up)?;
        chart
            .configure_mesh()
            .light_line_style(TRANSPARENT)
            .bold_line_style(BLACK.mix(0.12))
            .x_desc(self.across.name)
            .y_desc(self.up.name)
            .x_label_formatter(&|x| label(self.across, *x))
            .y_label_formatter(&|y| label(self.up, *y))
            .label_style(("sans-serif", 13))
            .draw()?;
        for curve in &self.curves {
            self.draw_curve(&mut chart, curve)?;
        }
        chart
            .configure_series_labels()
            .position(SeriesLabelPosition::UpperRight)
            .legend_area_size(30)
            .label_font(("sans-serif", 13))
            .background_style(WHITE.mix(0.85))
            .border_style(BLACK.mix(0.3))
            .draw()?;
        Ok(())
    }

    fn draw_curve<'b, X, Y>(
        &self,
        chart: &mut ChartContext<'b, SVGBackend<'b>, Cartesian2d<X, Y>>,
        curve: &Curve,
    ) -> Result<(), Box<dyn Error>>
    where
        X: Ranged<ValueType = f64>,
        Y: Ranged<ValueType = f64>,
    {
        let [r, g, b] = curve.colour;
        let (colour, stroke) = (RGBColor(r, g, b), curve.stroke);
        let line = colour.stroke_width(2);
        let sound = |&(x, y): &(f64, f64)| {
            let fits = |value: f64, axis: Axis<'_>| {
                value.is_finite() && (value > 0.0 || !axis.logarithmic)
            };
            fits(x, self.across) && fits(y, self.up)
        };
        let points: Vec<(f64, f64)> = curve.points.iter().copied().filter(sound).collect();
        let drawn = match stroke {
            Stroke::Ticks(row) => {
                let range = chart.y_range();
                let at = |share: f64| range.start + share * (range.end - range.start);
                let [foot, top] = [0.1, 0.9].map(|part| at((f64::from(row) + part) * TICK));
                let tick = |&(x, _): &(f64, f64)| {
                    PathElement::new([(x, foot), (x, top)], colour.stroke_width(1))
                };
                chart.draw_series(points.iter().map(tick))?
            }
            Stroke::Dashed => chart.draw_series(DashedLineSeries::new(points, 6, 4, line))?,
            Stroke::Line => chart.draw_series(LineSeries::new(points, line))?,
            Stroke::Circles => {
                chart.draw_series(LineSeries::new(points.iter().copied(), line))?;
                let mark = |at| Circle::new(at, 4, colour.filled());
                chart.draw_series(points.iter().copied().map(mark))?
            }
            Stroke::Squares => {
                chart.draw_series(LineSeries::new(points.iter().copied(), line))?;
                let square = |at| {
                    EmptyElement::at(at)
                        + Rectangle::new([(-4, -4), (4, 4)], WHITE.filled())
                        + Rectangle::new([(-4, -4), (4, 4)], line)
                };
                chart.draw_series(points.iter().copied().map(square))?
            }
        };
        if curve.name.is_empty() {
            return Ok(());
        }
        let drawn = drawn.label(&curve.name);
        let across = |(x, y)| [(x, y), (x + 24, y)];
        match stroke {
            Stroke::Dashed => {
                drawn.legend(move |at| DashedPathElement::new(across(at), 6, 4, line));
            }
            Stroke::Ticks(_) => {
                let upright = |(x, y)| [(x + 12, y - 5), (x + 12, y + 5)];
                drawn.legend(move |at| PathElement::new(upright(at), line));
            }
            _ => {
                drawn.legend(move |at| PathElement::new(across(at), line));
            }
        }
        Ok(())
    }
}

/// What stands beside a line across the plot: on logarithmic axes only at 1, 2, and 5, since others crowd.
fn label(axis: Axis<'_>, value: f64) -> String {
    let leading = value / 10_f64.powf(value.abs().log10().floor());
    let crowds =
        axis.logarithmic && ![1.0, 2.0, 5.0, 10.0].iter().any(|x| (x - leading).abs() < 1e-6);
    if crowds { String::new() } else { short(value) }
}

/// A number with as few digits as it needs.
fn short(x: f64) -> String {
    let size = x.abs();
    if x == 0.0 {
        "0".to_owned()
    } else if !(1e-3..1e6).contains(&size) {
        format!("{x:.0e}")
    } else {
        let digits = (2 - size.log10().floor() as i32).max(0) as usize;
        let text = format!("{x:.digits$}");
        if text.contains('.') {
            text.trim_end_matches('0').trim_end_matches('.').to_owned()
        } else {
            text
        }
    }
}
