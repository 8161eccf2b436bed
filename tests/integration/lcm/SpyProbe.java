// Reads the table that a person sees in lcm-spy's window. SpyProbe is a Java agent. Each time a new
// channel appears in the table, the agent prints all rows, with tabs between the cells.
// lcm-spy itself is unchanged:
//
//   JAVA_TOOL_OPTIONS=-javaagent:probe.jar fogline spy --lcm-url URL
import java.awt.Component;
import java.awt.Container;
import java.awt.Frame;
import java.util.StringJoiner;
import javax.swing.JTable;
import javax.swing.Timer;

public final class SpyProbe {
  private static final int LOOK_EVERY_MS = 50;
  private static int rowsShown = 0;

  public static void premain(String arguments) {
    new Timer(LOOK_EVERY_MS, event -> look()).start();  // runs on the thread that owns the window
  }

  private static void look() {
    for (Frame frame : Frame.getFrames()) {
      JTable table = findTable(frame);
      if (table == null || table.getRowCount() <= rowsShown) continue;
      try {
        int rows = table.getRowCount();
        System.out.print(text(table, rows));
        System.out.flush();
        rowsShown = rows;
      } catch (IndexOutOfBoundsException error) {
        // lcm-spy adds rows on another thread, its LCM thread, and a row was not complete yet. A
        // later call of look() finds the complete row, at the latest when lcm-spy adds another row.
      }
    }
  }

  private static JTable findTable(Component component) {
    if (component instanceof JTable) return (JTable) component;
    if (!(component instanceof Container)) return null;
    for (Component child : ((Container) component).getComponents()) {
      JTable table = findTable(child);
      if (table != null) return table;
    }
    return null;
  }

  private static String text(JTable table, int rows) {
    StringBuilder text = new StringBuilder();
    for (int row = 0; row < rows; ++row) {
      StringJoiner cells = new StringJoiner("\t", "row\t", "\n");
      for (int column = 0; column < table.getColumnCount(); ++column) {
        cells.add(String.valueOf(table.getValueAt(row, column)).trim());
      }
      text.append(cells);
    }
    return text.append("end of table\n").toString();
  }
}
